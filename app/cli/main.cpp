// The main function, which handles all exceptions.
#include <fmt/format.h>

#include <new>
#include <optional>

#include "app/cli/cli.hpp"
#include "app/run/thread_choice.hpp"
#include "core/error.hpp"
#include "core/parallel/communicator.hpp"
#include "io/system/process.hpp"

namespace {

constexpr int run_failed = 1, scene_wrong = 2, environment_wrong = 3, run_stopped = 4;

}  // namespace

int main(int argc, char** argv)
{
  talus::let_waiting_threads_sleep_soon(argv);
  talus::prepare_process();
  std::optional<talus::Ranks> ranks;
  const auto fail = [&](int code, const char* what) {
    talus::leave_process();
    if (ranks) {
      ranks->end(code, what);
    } else {
      std::fflush(stdout);
      std::fprintf(stderr, "%s\n", what);
    }
    if (code == environment_wrong)
      talus::end_at_once(code);
    return code;
  };
  try {
    ranks.emplace();
    const int code = talus::cli(argc, argv);
    if (const std::string why = talus::unwritten_output(); code == 0 && !why.empty())
      throw talus::EnvironmentError(why);
    talus::leave_process();
    return ranks->end(code);
  } catch (const talus::SceneErrors& e) {
    return fail(scene_wrong, e.what());
  } catch (const talus::Stopped& e) {
    return fail(run_stopped, e.what());
  } catch (const talus::RunError& e) {
    return fail(run_failed, fmt::format("error: {}", e.what()).c_str());
  } catch (const talus::EnvironmentError& e) {
    return fail(environment_wrong, fmt::format("error: {}", e.what()).c_str());
  } catch (const talus::Error& e) {
    return fail(scene_wrong, fmt::format("error: {}", e.what()).c_str());
  } catch (const std::bad_alloc&) {
    return fail(environment_wrong, "error: not enough memory");
  } catch (const std::exception& e) {
    return fail(environment_wrong, fmt::format("error: {}", e.what()).c_str());
  } catch (...) {
    return fail(environment_wrong, "error: an exception of an unknown kind");
  }
}
