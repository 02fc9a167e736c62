#include "io/output/ranks_json.hpp"

#include <nlohmann/json.hpp>

#include "io/files/atomic_file.hpp"

namespace talus {

void write_ranks(const std::filesystem::path& file, const RanksReport& report)
{
  const BenchSetting& s = report.setting;
  nlohmann::ordered_json json;
  json["format"] = "talus bench ranks 1";
  json["program"] = {{"version", report.version}, {"commit", report.commit}, {"compiler", report.compiler}, {"build", report.build}};
  json["machine"] = {{"processor", report.processor}, {"cores", report.cores}};
  json["setting"] = {{"kernel", s.kernel},       {"transfer", s.transfer}, {"law", s.law},
                     {"dimension", s.dimension}, {"per_cell", s.per_cell}, {"threads", s.threads},
                     {"precision", s.precision}};
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
