#include "io/output/convergence_json.hpp"

#include <nlohmann/json.hpp>

namespace talus {

namespace {

using ConvergenceJson = nlohmann::ordered_json;

ConvergenceJson value_or_null(const std::optional<Real>& value) { return value ? ConvergenceJson(*value) : ConvergenceJson(); }

ConvergenceJson level_object(const ConvergenceLevelRecord& level)
{
  return {{"factor", level.factor},  {"cell_size [m]", level.size}, {"cells", level.cells},   {"particles", level.particles},
          {"state", level.state},    {"set", level.changes},        {"folder", level.folder}, {"scene_digest", level.scene_digest},
          {"command", level.command}};
}

ConvergenceJson number_object(const ConvergenceNumberRecord& number)
{
  ConvergenceJson values = ConvergenceJson::array();
  for (const std::optional<Real>& value : number.values)
    values.push_back(value_or_null(value));
  return {{"quantity", number.name},
          {"unit", number.unit},
          {"values", std::move(values)},
          {"trend", number.trend},
          {"order", value_or_null(number.order)},
          {"extrapolated", value_or_null(number.extrapolated)},
          {"uncertainty", value_or_null(number.uncertainty)},
          {"verdict", number.verdict}};
}

}  // namespace

std::string to_json(const ConvergenceRecord& record)
{
  ConvergenceJson json;
  json["scene"] = record.scene;
  json["commit"] = record.commit;
  json["ratio"] = record.ratio;
  json["criteria"] = {{"safety_factor", record.safety_factor},
                      {"lowest_order", record.lowest_order},
                      {"highest_order", record.highest_order},
                      {"formal_order", record.formal_order}};
  json["levels"] = ConvergenceJson::array();
  for (const ConvergenceLevelRecord& level : record.levels)
    json["levels"].push_back(level_object(level));
  json["numbers"] = ConvergenceJson::array();
  for (const ConvergenceNumberRecord& number : record.numbers)
    json["numbers"].push_back(number_object(number));
  json["warnings"] = record.warnings;
  return json.dump(2, ' ', false, ConvergenceJson::error_handler_t::replace) + '\n';
}

}  // namespace talus
