#include "io/scene/scene_rules.hpp"

#include "io/document/key_aliases.hpp"
#include "io/scene/scene_rule_base.hpp"
#include "kernels/kernels.hpp"

namespace talus {

namespace {

class Rules : private SceneRuleBase {
 public:
  using SceneRuleBase::SceneRuleBase;

  std::vector<Finding> broken()
  {
    kernel();
    append(broken_mesh_rules(scene_));
    time();
    materials_and_bodies();
    append(broken_variation_rules(scene_));
    contacts();
    cuts();
    append(broken_rigid_rules(scene_));
    append(broken_reference_rules(scene_));
    loads_and_boundaries();
    append(broken_output_rules(scene_));
    append(broken_stage_rules(scene_));
    return std::move(findings_);
  }

 private:
  void append(const std::vector<Finding>& more) { findings_.insert(findings_.end(), more.begin(), more.end()); }

  void kernel()
  {
    if (const std::string_view removed = removed_choice(scene_.kernel); !removed.empty())
      add("kernel", fmt::format("there is no kernel \"{}\": {}", scene_.kernel, removed));
    else
      known_word("kernel", "kernel", scene_.kernel, kernel_names());
    const auto only_of = [&](std::string_view kernel, bool given) {
      if (given && scene_.kernel != kernel)
        add(std::string(kernel), fmt::format("these are choices of the kernel {}; the scene's is {}", kernel, scene_.kernel));
    };
    only_of("umls", scene_.umls.has_value());
    only_of("projected", scene_.projected.has_value());
    if (scene_.kernel == "projected" && scene_.transfer.scheme == Scheme::apic)
      add("transfer.scheme", "apic takes its matrix from the weights of particles, which projected does not make; take tpic or aflip");
    if (scene_.transfer.is_symmetric())
      symmetric_transfer();
    if (scene_.transfer.pic_damping_fall_times && !against_gravity(scene_))
      add("transfer.pic_damping_fall_times", "it counts in sqrt(h/g), and the scene has no gravity; give pic_damping_crossings");
  }

  void symmetric_transfer()
  {
    if (scene_.kernel != "projected")
      add("transfer.scheme",
          fmt::format("saflip is for the kernel projected, and the scene's is {}: leave `kernel` out, or take aflip", scene_.kernel));
    if (!scene_.cuts.empty())
      add("transfer.scheme", "saflip does not know the sides of cuts: take aflip");
    if (std::ranges::any_of(scene_.rigid, &RigidSpec::is_sheet))
      add("transfer.scheme", "saflip does not know the sides of sheets: take aflip");
  }

  void time()
  {
    if (scene_.stages.empty() && scene_.time.end == 0)
      add("time", "time.end or stages must say when the run ends");
    if (!scene_.stages.empty() && scene_.time.end != 0)
      add("time.end", "the stages say when the run ends: leave this out");
    for (std::size_t i = 1; i < scene_.stages.size(); ++i)
      if (initial_stress_of(scene_.stages[i]) != nullptr && changes_of(scene_.stages[i]).appear.empty())
        add(fmt::format("stages[{}].initial_stress", i), "only the first stage can set the stress, or one in which bodies appear: theirs");
    for (std::size_t i = 0; i < scene_.stages.size(); ++i)
      if (const K0Spec* const stress = initial_stress_of(scene_.stages[i]))
        initial_stress(fmt::format("stages[{}].initial_stress", i), static_cast<Index>(i), *stress);
  }

  void initial_stress(const std::string& path, Index number, const K0Spec& spec)
  {
    const auto known = names(scene_.bodies);
    for (std::size_t i = 0; i < spec.bodies.size(); ++i) {
      known_word(fmt::format("{}.bodies[{}].body", path, i), "body", spec.bodies[i].body, known);
      if (const auto body = std::ranges::find(scene_.bodies, spec.bodies[i].body, &BodySpec::name);
          body != scene_.bodies.end() && body->initial)
        add(fmt::format("{}.bodies[{}].body", path, i),
            fmt::format("the stress of \"{}\" comes from its table (initial): leave this out", body->name));
      for (std::size_t j = 0; j < i; ++j)
        if (spec.bodies[j].body == spec.bodies[i].body)
          add(fmt::format("{}.bodies[{}].body", path, i), fmt::format("bodies[{}] is about \"{}\" already", j, spec.bodies[i].body));
    }
    if (number == 0 && std::ranges::all_of(scene_.bodies, [](const BodySpec& body) { return body.initial.has_value(); }))
      add(path, "the stress of all bodies comes from their tables (initial): leave this out");
    for (const auto& [body, from_table] : bodies_and_tables())
      if (!from_table && presence_of(body, scene_.stages).from == number && spec.of(body).given() == 0)
        add(path, fmt::format("body \"{}\" has no k0: one of k0, k0_table, from_friction or stress is needed for the bodies that the "
                              "list does not name",
                              body));
    if (spec.stress)
      plane_stress(path + ".stress", *spec.stress);
    for (std::size_t i = 0; i < spec.bodies.size(); ++i)
      if (spec.bodies[i].stress)
        plane_stress(fmt::format("{}.bodies[{}].stress", path, i), *spec.bodies[i].stress);
  }

  /// The names of bodies, and whether a table has their stress.
  std::vector<std::pair<std::string, bool>> bodies_and_tables() const
  {
    std::vector<std::pair<std::string, bool>> all;
    for (const BodySpec& body : scene_.bodies)
      all.emplace_back(body.name, body.initial.has_value());
    return all;
  }

  /// In plane strain there is no shear out of the plane.
  void plane_stress(const std::string& path, const UniformStressSpec& stress)
  {
    if (scene_.dimension == 2 && (stress.yz != 0 || stress.xz != 0))
      add(path + (stress.yz != 0 ? ".yz" : ".xz"), "in 2 dimensions there is no shear stress out of the plane: leave this out");
  }

  void materials_and_bodies()
  {
    different_names("materials", scene_.materials);
    different_names("bodies", scene_.bodies);
    const auto known = names(scene_.materials);
    const bool all_known = !known.empty() && std::find(known.begin(), known.end(), "") == known.end();
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      const BodySpec& body = scene_.bodies[i];
      const std::string path = fmt::format("bodies[{}]", i);
      if (all_known)
        known_word(path + ".material", "material", body.material, known);
      fits(path + ".velocity", body.velocity);
      if (body.shape)
        fits(path + ".shape", *body.shape);
      source_of_particles(path, body);
      if (body.saturated_density && !scene_.water)
        add(path + ".saturated_density", "there is no water in this scene: say where its table is, or leave this out");
    }
    if (scene_.initial)
      initial(*scene_.initial);
    if (scene_.water)
      water(*scene_.water);
  }

  /// A body is either filled or taken from another run, and its keys must fit.  Without a list only the other run determines which bodies
  /// are taken.
  void source_of_particles(const std::string& path, const BodySpec& body)
  {
    const auto& list = scene_.initial ? scene_.initial->bodies : std::vector<TakenSpec>{};
    const auto known = names(scene_.bodies);
    const bool listed = std::any_of(list.begin(), list.end(), [&](const TakenSpec& taken) { return taken.body == body.name; });
    const bool misspelt = std::any_of(
        list.begin(), list.end(), [&](const TakenSpec& taken) { return std::find(known.begin(), known.end(), taken.body) == known.end(); });
    if (!body.region.empty() && body.shape)
      return add(path, "only one of region or shape may be given");
    if (misspelt && !listed && !body.fills())
      return;  // it may be the right one
    if (!listed && !body.fills() && (!scene_.initial || !list.empty()))
      return add(path, fmt::format("one of region or shape is needed{}", list.empty() ? "" : ": initial.bodies does not name this body"));
    if (body.fills() && !listed)
      return;
    body.for_each_key_of_filling([&](std::string_view key, bool given) {
      if (given)
        add(fmt::format("{}.{}", path, key), fmt::format("the particles of this body come from initial.from: leave {} out", key));
    });
  }

  void water(const WaterSpec& water)
  {
    const auto known = names(scene_.bodies);
    const auto different_bodies = [&](std::string_view key, const std::vector<std::string>& list) {
      for (auto name = list.begin(); name != list.end(); ++name) {
        const std::string path = fmt::format("water.{}[{}]", key, name - list.begin());
        known_word(path, "body", *name, known);
        if (std::find(list.begin(), name, *name) != name)
          add(path, fmt::format("\"{}\" is named twice", *name));
      }
    };
    different_bodies("bodies", water.bodies);
    different_bodies("undrained", water.undrained);
    const bool weighs = std::ranges::any_of(scene_.loads, [](const LoadSpec& l) { return std::holds_alternative<GravitySpec>(l); });
    if (water.flow)
      flow(water, *water.flow);
    else if (!weighs)
      add("water", "water has no weight without a load of type gravity");
    if (water.flow && !weighs && !water.flow->heads.empty())
      add("water.flow.heads[0]", "open water has no weight without a load of type gravity");
    if (water.flow && !weighs && water.flow->rain)
      add("water.flow.rain", "rain does not fall without a load of type gravity");
    if (water.flow && !weighs && water.flow->pond)
      add("water.flow.pond", "open water has no weight without a load of type gravity");
    for (std::size_t i = 0; water.flow && i < scene_.loads.size(); ++i)
      if (const auto* load = std::get_if<BodyForceSpec>(&scene_.loads[i]); load != nullptr && load->place == PlaceOf::start)
        add(fmt::format("loads[{}].place", i), "flowing water has no place at the start: use now, or leave out water.flow");
  }

  void flow(const WaterSpec& water, const FlowSpec& flow)
  {
    const auto known = names(scene_.bodies);
    for (std::size_t i = 0; i < flow.bodies.size(); ++i) {
      const std::string path = fmt::format("water.flow.bodies[{}].body", i), &body = flow.bodies[i].body;
      if (!known_word(path, "body", body, known))
        continue;
      if (std::ranges::count(flow.bodies.begin(), flow.bodies.begin() + static_cast<std::ptrdiff_t>(i), body, &PoresSpec::body) > 0)
        add(path, fmt::format("\"{}\" has pores already", body));
      if (!is_drained(water, body))
        add(path, fmt::format("water cannot flow through \"{}\", whose law sees total stress (water.bodies, water.undrained)", body));
    }
    if (!scene_.contacts.empty())
      add("contacts",
          "bodies have one pressure of flowing water, and may not have velocities of their own: leave out contacts or water.flow");
    if (!scene_.cuts.empty())
      add("cuts", "flowing water does not know cuts: leave out cuts or water.flow");
    if (std::ranges::any_of(scene_.rigid, &RigidSpec::is_sheet))
      add("rigid", "flowing water does not know sheets: leave out the sheets or water.flow");
  }

  void contacts()
  {
    const auto known = names(scene_.bodies);
    for (std::size_t i = 0; i < scene_.contacts.size(); ++i) {
      const ContactSpec& contact = scene_.contacts[i];
      for (std::size_t k = 0; k < contact.between.size(); ++k)
        known_word(fmt::format("contacts[{}].between[{}]", i, k), "body", contact.between[k], known);
      for (std::size_t j = 0; j < i; ++j)
        if (std::ranges::is_permutation(contact.between, scene_.contacts[j].between))
          add(fmt::format("contacts[{}].between", i),
              fmt::format("contacts[{}] is between \"{}\" already", j, fmt::join(contact.between, "\" and \"")));
    }
    if (scene_.contacts.empty())
      return;
    for (std::size_t i = 0; i < scene_.boundaries.size(); ++i)
      if (has_dashpots(scene_.boundaries[i]))
        add(fmt::format("boundaries[{}]", i),
            "absorbing boundaries hold one velocity field, and with contacts there are several: leave one out");
    for (std::size_t i = 0; i < scene_.loads.size(); ++i)
      if (const auto* load = std::get_if<TractionSpec>(&scene_.loads[i]); load != nullptr && load->carried_by == Carrier::mesh)
        add(fmt::format("loads[{}].carried_by", i),
            "what the mesh carries acts on no body in particular: with contacts let particles carry it");
  }

  void cuts()
  {
    for (std::size_t i = 0; i < scene_.cuts.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (scene_.cuts[i].on == scene_.cuts[j].on)
          add(fmt::format("cuts[{}].on", i), fmt::format("cuts[{}] is on \"{}\" already", j, scene_.cuts[i].on));
    if (scene_.cuts.empty())
      return;
    if (!scene_.contacts.empty())
      add("cuts", "cuts have one velocity field, and with contacts there are several: leave one out");
    if (scene_.kernel == "projected" && scene_.projected && scene_.projected->surfaces == AtSurfaces::extended)
      add("projected.surfaces", "extended surfaces do not know the sides of cuts: leave one out");
    for (std::size_t i = 0; i < scene_.boundaries.size(); ++i)
      if (has_dashpots(scene_.boundaries[i]))
        add(fmt::format("boundaries[{}]", i), "absorbing boundaries and cuts have not been made for each other: leave one out");
  }

  void initial(const InitialSpec& initial)
  {
    const auto known = names(scene_.bodies);
    const auto source = [](const TakenSpec& taken) { return taken.from.empty() ? taken.body : taken.from; };
    for (auto taken = initial.bodies.begin(); taken != initial.bodies.end(); ++taken) {
      const std::string path = fmt::format("initial.bodies[{}]", taken - initial.bodies.begin());
      known_word(path + ".body", "body", taken->body, known);
      for (auto earlier = initial.bodies.begin(); earlier != taken; ++earlier) {
        const auto at = earlier - initial.bodies.begin();
        if (!taken->body.empty() && earlier->body == taken->body)
          add(path + ".body", fmt::format("\"{}\" takes its particles by initial.bodies[{}] already", taken->body, at));
        else if (!taken->body.empty() && source(*earlier) == source(*taken))
          add(path, fmt::format("\"{}\" is taken by initial.bodies[{}] already", source(*taken), at));
      }
    }
    if (!scene_.stages.empty() && initial_stress_of(scene_.stages.front()) != nullptr)
      add("stages[0].initial_stress", "the stress comes from initial.from: leave this out");
  }

  void loads_and_boundaries()
  {
    std::optional<std::size_t> gravity;
    for (std::size_t i = 0; i < scene_.loads.size(); ++i) {
      const std::string path = fmt::format("loads[{}]", i);
      if (const auto* load = std::get_if<GravitySpec>(&scene_.loads[i])) {
        fits(path + ".acceleration", load->acceleration);
        if (gravity)
          add(path, fmt::format("gravity is given by loads[{}] already", *gravity));
        gravity = gravity ? gravity : i;
      }
      if (const auto* load = std::get_if<BodyForceSpec>(&scene_.loads[i]))
        fits(path + ".acceleration", load->acceleration);
      if (const auto* load = std::get_if<TractionSpec>(&scene_.loads[i]))
        fits(path + ".traction", load->traction);
    }
    for (std::size_t i = 0; i < scene_.boundaries.size(); ++i) {
      const std::string path = fmt::format("boundaries[{}]", i);
      std::visit(
          [&](const auto& boundary) {
            if constexpr (requires { boundary.velocity; })
              fits(path + ".velocity", boundary.velocity);
          },
          scene_.boundaries[i]);
      if (has_dashpots(scene_.boundaries[i]) && gravity && !begins_at_rest())
        add(path, fmt::format("it carries on what it carried at rest, and nothing says what that is: let the stages begin with a geostatic "
                              "one, take the state from another run (initial), or leave loads[{}] out",
                              *gravity));
    }
  }

  /// Whether the bodies begin in equilibrium with the loads, as far as the scene tells.
  bool begins_at_rest() const
  {
    return scene_.initial || std::ranges::all_of(scene_.bodies, [](const BodySpec& body) { return body.initial.has_value(); }) ||
           (!scene_.stages.empty() && seeks_equilibrium(scene_.stages.front()));
  }
};

}  // namespace

std::vector<Finding> broken_rules(const Scene& scene) { return Rules(scene).broken(); }

std::vector<std::string> kernel_names()
{
  std::vector<std::string> names;
  for_each_type(Kernels<2>{}, [&]<class K>() {
    constexpr std::string_view name = K::name;  // a copy, so that nothing of the kernel is linked
    names.emplace_back(name);
  });
  return names;
}

}  // namespace talus
