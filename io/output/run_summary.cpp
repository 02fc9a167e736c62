// RunSummary as JSON.  The order of keys is fixed, so that two summaries can be compared line by line.
#include "io/output/run_summary.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "io/files/atomic_file.hpp"

namespace talus {

namespace {

using Json = nlohmann::ordered_json;

Json to_object(const std::vector<NamedValue>& values)
{
  Json object = Json::object();
  for (const auto& [name, value, unit] : values)
    object[unit.empty() ? name : name + " [" + unit + "]"] = value;
  return object;
}

Json to_object(const BodySummary& body)
{
  return {{"name", body.name}, {"material", body.material}, {"law", body.law}, {"particles", body.particles}, {"mass [kg]", body.mass}};
}

Json to_object(const OriginSummary::Taken& taken) { return {{"body", taken.body}, {"from", taken.from}, {"particles", taken.particles}}; }

Json to_object(const StageSummary& stage)
{
  Json object = {
      {"kind", stage.kind}, {"name", stage.name}, {"result", stage.result}, {"steps", stage.steps}, {"duration [s]", stage.duration}};
  if (stage.residual)
    object["residual"] = *stage.residual;
  if (stage.first_residual)
    object["residual_at_begin"] = *stage.first_residual;
  return object;
}

Json to_object(const StartStateSummary& start)
{
  return {{"body", start.body},
          {"file", start.file},
          {"points", start.points},
          {"particles", start.particles},
          {"beyond_yield", start.beyond_yield},
          {"largest_return", start.largest_return},
          {"farthest [m]", start.farthest}};
}

template <class Item>
Json to_list(const std::vector<Item>& items)
{
  Json list = Json::array();
  for (const Item& item : items)
    list.push_back(to_object(item));
  return list;
}

Json to_object(const OriginSummary& origin)
{
  return {{"file", origin.file},
          {"step", origin.step},
          {"time [s]", origin.time},
          {"bodies", to_list(origin.bodies)},
          {"title", origin.title},
          {"scene", origin.scene_file},
          {"mesh_digest", origin.mesh_digest},
          {"program", {{"version", origin.version}, {"commit", origin.commit}}}};
}

Json program(const RunSummary& s) { return {{"version", s.version}, {"commit", s.commit}, {"compiler", s.compiler}, {"build", s.build}}; }

Json to_object(const RanksSummary& ranks)
{
  Json object{{"count", ranks.count}};
  if (ranks.count > 1)
    object.update({{"particles_of_the_busiest_over_mean", ranks.imbalance},
                   {"cells_held_over_own", ranks.cells_held},
                   {"messages_per_step", ranks.messages},
                   {"bytes_per_step [B]", ranks.bytes},
                   {"collectives_per_step", ranks.collectives},
                   {"collective_bytes_per_step [B]", ranks.collective_bytes},
                   {"share_of_particles_moved_per_step", ranks.particles_moved},
                   {"rebalances", ranks.rebalances},
                   {"rebalancing [s]", ranks.rebalancing}});
  return object;
}

Json cost(const RunSummary& s)
{
  return {{"ranks", to_object(s.ranks)},
          {"threads", s.threads},
          {"wall [s]", s.wall_total},
          {"wall_by_phase", to_object(s.wall_seconds)},
          {"particle_steps_per_second", s.particle_steps_per_second},
          {"bytes_per_particle", s.bytes_per_particle},
          {"peak_memory [B]", s.peak_memory_bytes}};
}

/// `object` with the relative error of its balance.
Json closed(Json object, const Closure& closure)
{
  object["closure"] = closure.relative;
  object["relative_to"] = closure.relative_to;
  object["closes"] = closure.closes();
  return object;
}

Json balance(const MomentumAudit& audit, const std::string& unit)
{
  Json object = closed({{"start " + unit, audit.start}, {"end " + unit, audit.end}, {"impulse " + unit, audit.impulse}}, audit.closure);
  if (!audit.transfer_loss.empty()) {
    object["transfer_loss " + unit] = audit.transfer_loss;
    object["transfer_loss_share"] = audit.transfer_share;
  }
  return object;
}

Json balances(const RunSummary& s)
{
  Json object = Json::object();
  if (s.energy)
    object["energy"] = closed({{"terms", to_object(s.energy->terms)}}, s.energy->closure);
  if (s.momentum)
    object["momentum"] = balance(*s.momentum, "[kg m/s]");
  if (s.angular_momentum)
    object["angular_momentum"] = balance(*s.angular_momentum, "[kg m^2/s]");
  if (s.mass)
    object["mass"] = closed({{"start [kg]", s.mass->start},
                             {"end [kg]", s.mass->end},
                             {"removed [kg]", s.mass->removed},
                             {"particles_removed", s.mass->particles_removed},
                             {"placed [kg]", s.mass->placed},
                             {"particles_placed", s.mass->particles_placed},
                             {"taken [kg]", s.mass->taken},
                             {"particles_taken", s.mass->particles_taken}},
                            s.mass->closure);
  return object;
}

Json to_object(const WatchSummary& watch)
{
  return {{"fastest [m/s]", watch.fastest}, {"speed_limit [m/s]", watch.speed_limit}, {"steps_beyond", watch.speeding},
          {"energy_gain", watch.gain},      {"energy_gain_limit", watch.gain_limit},  {"looks_beyond", watch.gaining}};
}

}  // namespace

std::string RunSummary::made_by() const
{
  return fmt::format("talus {}, commit {}, {}, {}; scene {}, mesh {}", version, commit, compiler, build, scene_digest, mesh_digest);
}

std::string to_json(const RunSummary& s)
{
  Json json;
  json["title"] = s.title;
  json["status"] = enum_names(s.status)[static_cast<std::size_t>(s.status)];
  if (!s.message.empty())
    json["message"] = s.message;
  json["program"] = program(s);
  json["dimension"] = s.dimension;
  json["kernel"] = s.kernel;
  json["transfer"] = s.transfer;
  json["mesh"] = {{"nodes", s.mesh_nodes},
                  {"cells", s.mesh_cells},
                  {"nodes_treated_as_corners", s.nodes_as_corners},
                  {"digest", s.mesh_digest},
                  {"quality", to_object(s.mesh_quality)}};
  json["bodies"] = to_list(s.bodies);
  if (s.origin)
    json["initial"] = to_object(*s.origin);
  if (!s.start_states.empty())
    json["start_states"] = to_list(s.start_states);
  json["stages"] = to_list(s.stages);
  if (!s.changes.empty())
    json["changes"] = s.changes;
  json["steps"] = s.steps;
  json["simulated_time [s]"] = s.simulated_time;
  json["cost"] = cost(s);
  json["balances"] = balances(s);
  json["watch"] = to_object(s.watch);
  if (!s.runout.empty())
    json["runout"] = to_object(s.runout);
  json["warnings"] = s.warnings;
  json["files"] = s.files;
  json["scene"] = {{"file", s.scene_file}, {"digest", s.scene_digest}, {"text", s.scene_text}, {"set", s.overrides}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';  // replace: a scene may contain bytes that are not UTF-8
}

void write_summary(const std::filesystem::path& file, const RunSummary& summary) { write_whole(file, to_json(summary)); }

}  // namespace talus
