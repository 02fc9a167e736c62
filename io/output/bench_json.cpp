// BenchReport to JSON and back, RanksReport to JSON.
#include "io/output/bench_json.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "io/document/document.hpp"
#include "io/files/atomic_file.hpp"

namespace talus {

namespace {

using OrderedJson = nlohmann::ordered_json;
constexpr auto bench_format = "talus bench 1";

OrderedJson object_of(const Measured& m) { return {{"median", m.median}, {"least", m.least}, {"most", m.most}}; }
Measured measured_of(const OrderedJson& json)
{
  return {json.at("median").get<Real>(), json.at("least").get<Real>(), json.at("most").get<Real>()};
}

OrderedJson object_of(const BenchResult& r)
{
  const BenchSetting& s = r.setting;
  OrderedJson json = {{"kernel", s.kernel},       {"transfer", s.transfer},   {"law", s.law},
                      {"dimension", s.dimension}, {"per_cell", s.per_cell},   {"threads", s.threads},
                      {"option", s.option},       {"particles", r.particles}, {"steps", r.steps}};
  json["particle_steps_per_second_and_core"] = 1e6 * r.rate();
  json["ns_per_particle_step"] = object_of(r.ns);
  json["cpu_ns_per_particle_step"] = object_of(r.cpu);
  json["phases [ns]"] = OrderedJson::object();
  for (const BenchPhase& phase : r.phases)
    json["phases [ns]"][phase.name] = phase.ns;
  json["repeats [ns]"] = r.repeats;
  json["bytes_per_particle"] = r.bytes_held;
  json["bytes_moved_per_particle_step"] = r.bytes_moved;
  return json;
}

BenchResult result_of(const OrderedJson& json)
{
  BenchResult r;
  BenchSetting& s = r.setting;
  for (const auto& [key, value] : {std::pair{"kernel", &s.kernel}, {"transfer", &s.transfer}, {"law", &s.law}, {"option", &s.option}})
    json.at(key).get_to(*value);
  for (const auto& [key, value] : {std::pair{"dimension", &s.dimension}, {"per_cell", &s.per_cell}, {"threads", &s.threads}})
    json.at(key).get_to(*value);
  json.at("particles").get_to(r.particles);
  json.at("steps").get_to(r.steps);
  r.ns = measured_of(json.at("ns_per_particle_step"));
  r.cpu = measured_of(json.at("cpu_ns_per_particle_step"));
  for (const auto& [name, value] : json.at("phases [ns]").items())
    r.phases.push_back({name, value.get<Real>()});
  json.at("repeats [ns]").get_to(r.repeats);
  json.at("bytes_per_particle").get_to(r.bytes_held);
  json.at("bytes_moved_per_particle_step").get_to(r.bytes_moved);
  return r;
}

BenchReport report_of(const OrderedJson& json)
{
  BenchReport report;
  const OrderedJson& program = json.at("program");
  for (const auto& [key, value] : {std::pair{"version", &report.version},
                                   {"commit", &report.commit},
                                   {"compiler", &report.compiler},
                                   {"build", &report.build},
                                   {"flags", &report.flags}})
    program.at(key).get_to(*value);
  const OrderedJson& machine = json.at("machine");
  machine.at("processor").get_to(report.processor);
  machine.at("cores").get_to(report.cores);
  for (const OrderedJson& result : json.at("cases"))
    report.results.push_back(result_of(result));
  return report;
}

}  // namespace

void write_bench(const std::filesystem::path& file, const BenchReport& report)
{
  OrderedJson json;
  json["format"] = bench_format;
  json["program"] = {{"version", report.version},
                     {"commit", report.commit},
                     {"compiler", report.compiler},
                     {"build", report.build},
                     {"flags", report.flags}};
  json["machine"] = {{"processor", report.processor}, {"cores", report.cores}};
  json["cases"] = OrderedJson::array();
  for (const BenchResult& result : report.results)
    json["cases"].push_back(object_of(result));
  write_whole(file, json.dump(2) + '\n');
}

BenchReport read_bench(const std::filesystem::path& file)
{
  const SourceLocation where{file.string(), 0, 0, ""};
  const std::string text = read_text(file);
  try {
    const OrderedJson json = OrderedJson::parse(text);
    const auto format = json.is_object() ? json.value("format", std::string()) : std::string();
    if (format != bench_format)
      throw SceneErrors(where, fmt::format("this is not what `talus bench --json` writes (\"format\": \"{}\")", bench_format));
    return report_of(json);
  } catch (const OrderedJson::exception& e) {
    throw SceneErrors(where, fmt::format("this is not what `talus bench --json` writes: {}", e.what()));
  }
}

void write_ranks(const std::filesystem::path& file, const RanksReport& report)
{
  const BenchSetting& s = report.setting;
  nlohmann::ordered_json json;
  json["format"] = "talus bench ranks 1";
  json["program"] = {{"version", report.version}, {"commit", report.commit}, {"compiler", report.compiler}, {"build", report.build}};
  json["machine"] = {{"processor", report.processor}, {"cores", report.cores}};
  json["setting"] = {{"kernel", s.kernel},       {"transfer", s.transfer}, {"law", s.law},
                     {"dimension", s.dimension}, {"per_cell", s.per_cell}, {"threads", s.threads}};
  json["particles"] = report.particles;
  json["cells"] = report.cells;
  json["nodes"] = report.nodes;
  json["steps"] = report.steps;
  json["step [s]"] = {{"median", report.seconds.median}, {"least", report.seconds.least}, {"most", report.seconds.most}};
  json["ranks"] = nlohmann::ordered_json::array();
  for (const std::vector<Real>& numbers : report.ranks) {
    nlohmann::ordered_json rank;
    for (std::size_t c = 0; c < numbers.size(); ++c)
      rank[report.columns[c]] = numbers[c];
    json["ranks"].push_back(std::move(rank));
  }
  write_whole(file, json.dump(2) + '\n');
}

}  // namespace talus
