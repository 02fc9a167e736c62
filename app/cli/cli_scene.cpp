// Commands for scenes.
#include "app/cli/cli_checks.hpp"
#include "app/cli/cli_commands.hpp"
#include "app/commands/new/new_command.hpp"
#include "core/word_match.hpp"
#include "materials/laboratory/laboratory.hpp"

namespace talus {

void SceneCommands::add_new(CLI::App& app)
{
  CLI::App* made = app.add_subcommand("new", "copy a commented scene, to be edited");
  made->add_option("template", new_.from, "name of a template (talus new --list), or the file of a scene")
      ->type_name(one_of(template_names()) + " or *.yaml");
  made->add_option("--out", new_.out, "file to write; default <template>.yaml")->type_name(scene_value);
  made->add_option("--set", new_.set, set_help);
  made->add_flag("--list", new_.list, "write nothing: tell the templates");
  made->add_flag("--force", new_.force, "replace the file if it is there");
  made->callback([this] { new_scene(new_); });
}

/// The change of a scene for a script whose path starts in the current folder.
std::string set_of_script(const std::string& file)
{
  std::string text = "script.file=\"";
  for (const char c : std::filesystem::absolute(file).string())
    text += c == '"' || c == '\\' ? std::string{'\\', c} : std::string(1, c);
  return text + '"';
}

void SceneCommands::add_run(CLI::App& app)
{
  CLI::App* run = app.add_subcommand("run", "run a scene");
  CLI::Option_group* what = run->add_option_group("what");
  CLI::Option* scene = what->add_option("scene", run_.scene, "scene file (.yaml)")->type_name(scene_value);
  what->add_option("--resume", run_.resume, "go on with a run that was stopped: its folder, or one of its checkpoints")
      ->type_name(folder_value);
  what->require_option(1);
  run->add_option("--out", run_.out, "folder for the results; default runs/<name of the scene>, or that of the run to go on with")
      ->type_name(folder_value);
  run->add_option("--threads", run_.threads, "threads to use; default what the scene says, or as many as pay for its particles")
      ->check(number_within(1, 1024));
  run->add_option("--set", run_.set, set_help);
  run->add_option_function<std::string>(
         "--script", [this](const std::string& file) { run_.set.push_back(set_of_script(file)); },
         "call the functions of this script in Python between the steps (script.file in a scene)")
      ->type_name("*.py")
      ->needs(scene);
  run->add_option("--until", run_.until, "stop after so many steps with a checkpoint, to go on from or to look at")
      ->check(number_not_below_zero());
  run->add_option("--rebalance", run_.rebalance,
                  "several ranks: share the run out anew every so many steps; 0: never; default when it pays")
      ->check(number_not_below_zero());
  run->add_flag("--quick", run_.quick, "coarse and short: only to see that the scene runs")->needs(scene);
  run->add_flag("--quiet", run_.quiet, "no progress and no table");
  run->add_flag("--strict", run_.strict, "balances that do not close are an error: exit code 1 (strict: true in a scene)");
  run->add_flag("--force", run_.force, "replace a run that was stopped, or has failed, and could go on from its checkpoints");
  run->add_flag("--dry-run", run_.dry, "write nothing: tell what the run would take in memory, files and time, from a few steps")
      ->needs(scene);
  run->callback([this] { run_.dry ? dry_run(run_) : run_scene(run_); });
}

void SceneCommands::add_check(CLI::App& app)
{
  CLI::App* check = app.add_subcommand("check", "find everything wrong with a scene and its mesh; say what a run would cost");
  check->add_option("scene", check_scene_, "scene file (.yaml)")->type_name(scene_value)->required();
  CLI::Option* set = check->add_option("--set", check_set_, set_help);
  CLI::Option* json = check->add_flag("--json", check_json_, "print what the scene consists of as JSON, for other programs");
  check->add_flag("--keys", check_keys_, "check the keys alone: make no mesh")->needs(json);
  check->add_option("--variants", variants_, "check each of the variants in this file, and print JSON: for programs that make many runs")
      ->type_name("*.json")
      ->excludes(set)
      ->excludes(json);
  check->callback([this] {
    if (variants_)
      check_variants(check_scene_, *variants_);
    else if (check_json_)
      check_as_json(check_scene_, check_set_, check_keys_);
    else
      check_scene(check_scene_, check_set_);
  });
}

void SceneCommands::add_mesh(CLI::App& app)
{
  CLI::App* mesh = app.add_subcommand("mesh", "quality and groups of a mesh; make it if need be");
  mesh->add_option("file", mesh_.file, "scene (.yaml), mesh (.msh) or geometry (.geo, .step)")
      ->type_name("*.yaml *.msh *.geo *.step")
      ->required();
  mesh->add_option("--out", mesh_.out, "write the mesh to this .msh")->type_name("*.msh");
  mesh->add_option("--size", mesh_.size, "edge length of the cells of a geometry [m]")->check(number_above_zero());
  mesh->add_option("--dimension", mesh_.dimension, "2 or 3; default that of the largest cells")->check(number_within(2, 3));
  mesh->add_option("--set", mesh_.set, set_help);
  mesh->callback([this] { show_mesh(mesh_); });
}

void SceneCommands::add_drive(CLI::App& app)
{
  CLI::App* drive = app.add_subcommand("drive", "drive one law along a path of strains and stresses, or through a laboratory test");
  drive->add_option("file", drive_.file, "material and paths (.yaml); with --test a scene")->type_name(scene_value)->required();
  drive->add_option("--out", drive_.out, "write the table to this .csv; default the screen, and with --test nowhere");
  drive->add_option("--set", drive_.set, set_help);
  constexpr auto tests = enum_names(Laboratory{});
  CLI::Option* test = drive->add_option("--test", drive_.test, or_list(std::vector<std::string>(tests.begin(), tests.end())));
  test->type_name(one_of(std::vector<std::string>(tests.begin(), tests.end())));
  const auto of_test = [&](const char* name, auto& value, const char* help) { return drive->add_option(name, value, help)->needs(test); };
  of_test("--material", drive_.material, "material of the scene; may be left out where there is one");
  of_test("--pressure", drive_.pressure, "stress at the start, equal in all directions [Pa]; default 1e5, for the last two tests 0")
      ->check(number_not_below_zero());
  of_test("--strain", drive_.strain, "axial or shear strain at the end; default 0.2, 0.2, 0.5, 0.05, 0.2")->check(number_above_zero());
  of_test("--rate", drive_.rate, "of this strain [1/s]; default 0.001")->check(number_above_zero());
  of_test("--plot", drive_.plot, "draw the curve and the closed forms into this .png");
  of_test("--steps", drive_.steps, "default 500")->check(number_within(1, most_steps));
  drive->callback([this] { drive_law(drive_); });
}

void SceneCommands::add_to(CLI::App& app)
{
  add_new(app);
  add_run(app);
  add_check(app);
  add_mesh(app);
  add_drive(app);
}

}  // namespace talus
