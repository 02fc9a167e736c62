#include "app/setup/contacts_of_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "solver/particles/staged_bodies.hpp"

namespace talus {

namespace {

/// Groups of bodies that share a velocity field, by the number of the first body of each.
class SharedFields {
 public:
  explicit SharedFields(std::size_t bodies) : first_(bodies) { std::iota(first_.begin(), first_.end(), std::size_t{0}); }
  std::size_t of(std::size_t body) const noexcept { return first_[body]; }
  void join(std::size_t a, std::size_t b)
  {
    const std::size_t from = std::max(first_[a], first_[b]), to = std::min(first_[a], first_[b]);
    std::ranges::replace(first_, from, to);
  }

 private:
  std::vector<std::size_t> first_;
};

}  // namespace

Contacts contacts_of(const Scene& scene, const std::vector<Body>& bodies, SceneErrorCollector& errors, std::vector<std::string>& warnings)
{
  const auto number = [&](const std::string& name) {
    return static_cast<std::size_t>(std::ranges::find(bodies, name, &Body::name) - bodies.begin());
  };
  const auto are_known = [&](const ContactSpec& contact) {  // a body that could not be filled is an error already
    return number(contact.between[0]) < bodies.size() && number(contact.between[1]) < bodies.size();
  };
  SharedFields shared(bodies.size());
  std::vector<std::uint8_t> is_apart(bodies.size(), 0);
  for (const ContactSpec& contact : scene.contacts) {
    if (!are_known(contact))
      continue;
    const std::size_t a = number(contact.between[0]), b = number(contact.between[1]);
    if (contact.tied)
      shared.join(a, b);
    else
      is_apart[a] = is_apart[b] = 1;
  }
  std::size_t others = bodies.size();
  for (std::size_t body = 0; body < bodies.size(); ++body)
    if (is_apart[body] == 0) {
      const bool is_tied = std::ranges::any_of(
          scene.contacts, [&](const ContactSpec& one) { return std::ranges::find(one.between, bodies[body].name) != one.between.end(); });
      if (!is_tied && others < bodies.size())
        shared.join(others, body);
      else if (!is_tied)
        others = body;
    }

  Contacts contacts;
  std::map<std::size_t, Index> field;  // by the first body
  for (std::size_t body = 0; body < bodies.size(); ++body)
    contacts.field_of_body.push_back(field.try_emplace(shared.of(body), static_cast<Index>(field.size())).first->second);
  contacts.n_fields = std::max(static_cast<Index>(field.size()), Index{1});
  std::map<std::pair<Index, Index>, const ContactSpec*> given;
  for (const ContactSpec& contact : scene.contacts) {
    if (contact.tied || !are_known(contact))
      continue;
    const auto fields = std::minmax(contacts.field_of_body[number(contact.between[0])], contacts.field_of_body[number(contact.between[1])]);
    if (fields.first == fields.second) {
      errors.add(contact.where, "between",
                 fmt::format("\"{}\" and \"{}\" are tied to each other by other contacts", contact.between[0], contact.between[1]));
      continue;
    }
    const auto [known, is_new] = given.try_emplace(fields, &contact);
    if (!is_new && (known->second->friction != contact.friction || known->second->cohesion != contact.cohesion))
      errors.add(contact.where, "between",
                 fmt::format("tied bodies slide as one, and the contact of \"{}\" with \"{}\" gives another friction or cohesion",
                             known->second->between[0], known->second->between[1]));
  }
  for (const auto& [first_a, a] : field)
    for (const auto& [first_b, b] : field) {
      if (a >= b)
        continue;
      ContactLaw law;
      law.first = a, law.second = b;
      law.first_body = bodies[first_a].name, law.second_body = bodies[first_b].name;
      if (const auto found = given.find({a, b}); found != given.end()) {
        const ContactSpec& contact = *found->second;
        law.friction = contact.friction, law.cohesion = contact.cohesion;
        const bool turned = contacts.field_of_body[number(contact.between[0])] != a;
        law.first_body = contact.between[turned ? 1 : 0], law.second_body = contact.between[turned ? 0 : 1];
      } else {
        warnings.push_back(
            fmt::format("{}: no contact says what acts between \"{}\" and \"{}\": where they touch, they slide without friction",
                        to_string(scene.contacts.front().where), bodies[first_a].name, bodies[first_b].name));
      }
      contacts.laws.push_back(std::move(law));
    }
  if (contacts.laws.empty())
    contacts.field_of_body.clear();
  return contacts;
}

std::string describe(const ContactLaw& law)
{
  std::string text = fmt::format("contact of \"{}\" and \"{}\": friction {:.6g}", law.first_body, law.second_body, law.friction);
  if (law.cohesion > 0)
    text += fmt::format(", cohesion {:.6g} Pa", law.cohesion);
  return text;
}

std::vector<CutLaw> cuts_of(const Scene& scene)
{
  std::vector<CutLaw> cuts;
  for (const CutSpec& cut : scene.cuts)
    cuts.push_back({.group = cut.on,
                    .friction = cut.friction,
                    .cohesion = cut.cohesion,
                    .tied_until = cut.tied ? std::numeric_limits<Real>::infinity() : cut.tied_until.value_or(0)});
  return cuts;
}

std::string describe(const CutLaw& law)
{
  std::string text = fmt::format("cut \"{}\": ", law.group);
  if (std::isinf(law.tied_until))
    return text + "tied";
  if (law.tied_until > 0)
    text += fmt::format("tied until {:.6g} s, then ", law.tied_until);
  text += fmt::format("friction {:.6g}", law.friction);
  if (law.cohesion > 0)
    text += fmt::format(", cohesion {:.6g} Pa", law.cohesion);
  return text;
}

template <int D>
void check_overlaps(const Scene& scene, const Mesh<D>& mesh, const Setup<D>& setup, Communicator& ranks, SceneErrorCollector& errors)
{
  const State<D>& state = setup.state;
  CellOrder order;
  const auto check = [&](const std::string& first, const std::string& second, const SourceLocation& where, const char* key) {
    if (presence_of(first, scene.stages).from != 0 || presence_of(second, scene.stages).from != 0)
      return;
    if (order.row.empty())
      sort_by_cell(state.particles.cell, state.particles.id, state.bodies, mesh.n_cells(), order);
    const auto volume = [&](const std::string& name) {
      return volume_in_cells(mesh, state.particles, order, [&](Index b) { return state.bodies[static_cast<std::size_t>(b)].name == name; });
    };
    if (const Overlap<D> taken = overlap<D>(mesh, volume(first), volume(second), ranks); taken.share() > most_overlap)
      errors.add(where, key,
                 fmt::format("\"{}\" overlaps \"{}\" at the start: {}; move one of them, or cut it out of the other by a shape of type "
                             "difference",
                             second, first, describe(taken)));
  };
  std::set<std::pair<std::string, std::string>> given;
  for (const ContactSpec& contact : scene.contacts) {
    given.insert(std::minmax(contact.between[0], contact.between[1]));
    if (!contact.tied)
      check(contact.between[0], contact.between[1], contact.where, "between");
  }
  // Other bodies with velocity fields of their own are in contact too: without friction, or by the contact of a body tied to them.
  const std::vector<Index>& field = setup.conditions.contacts.field_of_body;
  for (std::size_t a = 0; a < field.size(); ++a)
    for (std::size_t b = a + 1; b < field.size(); ++b) {
      const std::string &first = state.bodies[a].name, &second = state.bodies[b].name;
      const auto spec = std::ranges::find(scene.bodies, second, &BodySpec::name);
      if (field[a] != field[b] && spec != scene.bodies.end() && !given.contains(std::minmax(first, second)))
        check(first, second, spec->where, "shape");
    }
}

template void check_overlaps(const Scene&, const Mesh<2>&, const Setup<2>&, Communicator&, SceneErrorCollector&);
template void check_overlaps(const Scene&, const Mesh<3>&, const Setup<3>&, Communicator&, SceneErrorCollector&);

}  // namespace talus
