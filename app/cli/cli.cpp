#include "app/cli/cli.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>

#include "app/cli/cli_commands.hpp"
#include "app/cli/completion.hpp"
#include "app/commands/info_command.hpp"
#include "core/parallel/communicator.hpp"
#include "core/version.hpp"
#include "core/word_match.hpp"

namespace talus {

namespace {

constexpr int usage_error = 2;

/// Whether all ranks take part in a command; other commands run on the root only.
bool is_shared_by_ranks(const CLI::App& command)
{
  return (command.get_name() == "run" && command.count("--dry-run") == 0) || (command.get_name() == "bench" && command.count("--mpi") > 0);
}

/// The commands and their options; lives as long as the parse.
class CommandLine {
 public:
  CommandLine() : app_("Talus: the material point method on triangles and tetrahedra", "talus")
  {
    app_.require_subcommand(1);
    app_.set_version_flag("--version", describe(version()));
    app_.set_help_all_flag("--help-all", "help of every command");
    scenes_.add_to(app_);
    results_.add_to(app_);
    studies_.add_to(app_);
    add_manual();
    add_completion();
    app_.add_subcommand("info", "version, laws, kernels, licence")->callback([] { print_info(); });
    app_.parse_complete_callback([this] { leave_to_root(*app_.get_subcommands().front()); });
  }

  int parse(int argc, const char* const* argv)
  {
    std::vector<std::string> commands;
    for (const CLI::App* command : app_.get_subcommands([](const CLI::App*) { return true; }))
      commands.push_back(command->get_name());
    if (argc > 1 && argv[1][0] != '-' && std::find(commands.begin(), commands.end(), argv[1]) == commands.end()) {
      if (world().is_root())
        fmt::print(stderr, "error: there is no command \"{}\"{}\n", argv[1], suggestion(argv[1], commands));
      return usage_error;
    }
    try {
      app_.parse(argc, argv);
      return results_.status();
    } catch (const CLI::ParseError& e) {
      const int code = world().is_root() ? app_.exit(e) : e.get_exit_code();
      return code == 0 ? 0 : usage_error;
    }
  }

 private:
  /// To be called before a command does its work, on each rank: ranks other than the root skip it, unless it is shared.
  static void leave_to_root(CLI::App& command)
  {
    if (!is_shared_by_ranks(command) && !goes_on_as_root())
      command.callback(nullptr);
  }

  void add_manual()
  {
    CLI::App* manual = app_.add_subcommand("manual", "every key of a scene, as Markdown; or what some of them mean");
    CLI::Option* words =
        manual->add_option("key", manual_words_, "keys, laws, kernels, types: friction_angle, materials.cohesion, mohr_coulomb");
    words->type_name("KEY");
    manual->add_flag("--schema", schema_, "as JSON Schema, for editors")->excludes(words);
    manual->callback([this] { print_manual(schema_, manual_words_); });
  }

  void add_completion()
  {
    CLI::App* completion = app_.add_subcommand("completion", "print what makes a shell complete commands, options and files");
    completion->add_option("shell", shell_, "which shell")->required()->check(CLI::IsMember(completion_shells()));
    completion->callback([this] {
      std::vector<CommandWords> commands;
      for (const CLI::App* command : app_.get_subcommands([](const CLI::App*) { return true; })) {
        commands.push_back({command->get_name(), command->get_description(), {}});
        add_options(*command, commands.back().options);
      }
      fmt::print("{}", completion_script(shell_, commands));
    });
  }

  /// Adds the options of a command and of the groups in it.
  static void add_options(const CLI::App& from, std::vector<OptionWords>& options)
  {
    for (const CLI::Option* option : from.get_options()) {
      OptionWords words{{}, option->get_items_expected_max() > 0 ? option->get_type_name() : "", option->get_description()};
      for (const std::string& name : option->get_snames())
        words.names.push_back("-" + name);
      for (const std::string& name : option->get_lnames())
        words.names.push_back("--" + name);
      options.push_back(std::move(words));
    }
    for (const CLI::App* group : from.get_subcommands([](const CLI::App*) { return true; }))
      add_options(*group, options);
  }

  CLI::App app_;
  SceneCommands scenes_;
  ResultCommands results_;
  StudyCommands studies_;
  std::vector<std::string> manual_words_;
  std::string shell_;
  bool schema_ = false;
};

}  // namespace

int cli(int argc, const char* const* argv) { return CommandLine().parse(argc, argv); }

}  // namespace talus
