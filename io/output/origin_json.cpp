#include "io/output/origin_json.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"

namespace talus {

namespace {

/// The text of a key; a number as it is written.
std::string told(const nlohmann::json& json, const char* key)
{
  const auto found = json.find(key);
  if (found == json.end())
    return "unknown";
  return found->is_string() ? found->get<std::string>() : found->dump();
}

}  // namespace

RunOrigin read_origin(const std::filesystem::path& summary)
{
  const std::string text = read_whole(summary);
  try {
    const nlohmann::json json = nlohmann::json::parse(text);
    const nlohmann::json& program = json.at("program");
    return {told(json, "status"),      told(program, "version"), told(program, "commit"),
            told(program, "compiler"), told(program, "build"),   told(json, "kernel"),
            told(json, "transfer"),    told(json, "precision"),  told(json.at("cost"), "threads")};
  } catch (const nlohmann::json::exception& e) {
    throw EnvironmentError(fmt::format("{} is not the summary of a run: {}", summary.string(), e.what()));
  }
}

}  // namespace talus
