#include "io/output/fos_json.hpp"

#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"

namespace talus {

namespace {

using FosJson = nlohmann::ordered_json;

FosJson number_or_null(const std::optional<Real>& value) { return value ? FosJson(*value) : FosJson(); }

}  // namespace

void write_fos(const std::filesystem::path& file, const FosRecord& record)
{
  FosJson json;
  json["scene"] = record.scene;
  json["commit"] = record.commit;
  json["factor_of_safety"] = number_or_null(record.factor);
  json["highest_that_holds"] = number_or_null(record.low);
  json["lowest_that_fails"] = number_or_null(record.high);
  json["hold_above_that"] = record.out_of_order;
  json["width"] = record.width;
  json["bodies"] = record.bodies;
  json["criterion"] = {{"growth", record.growth_limit},
                       {"kinetic_over_peak", record.liveliness_limit},
                       {"steadiness", record.steadiness_limit},
                       {"settlement [m]", record.settlement},
                       {"height [m]", record.height}};
  json["trials"] = FosJson::array();
  for (const FosTrialRecord& trial : record.trials)
    json["trials"].push_back({{"factor", trial.factor},
                              {"verdict", trial.verdict},
                              {"moved [m]", number_or_null(trial.moved)},
                              {"growth", number_or_null(trial.growth)},
                              {"kinetic_over_peak", number_or_null(trial.liveliness)},
                              {"steadiness", number_or_null(trial.steadiness)},
                              {"duration [s]", number_or_null(trial.duration)},
                              {"by_growth_alone", trial.by_growth_alone},
                              {"message", trial.message},
                              {"folder", trial.folder},
                              {"scene_digest", trial.scene_digest},
                              {"command", trial.command}});
  write_whole(file, json.dump(2, ' ', false, FosJson::error_handler_t::replace) + '\n');
}

std::vector<std::string> broken_off(const std::filesystem::path& file)
try {
  const FosJson json = FosJson::parse(read_whole(file));
  std::vector<std::string> digests;
  for (const FosJson& trial : json.at("trials"))
    if (!trial.at("message").get<std::string>().empty())
      digests.push_back(trial.at("scene_digest").get<std::string>());
  return digests;
} catch (const FosJson::exception&) {
  return {};
} catch (const EnvironmentError&) {  // the file does not exist yet
  return {};
}

}  // namespace talus
