#include "app/setup/contacts_of_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

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
  SharedFields shared(bodies.size());
  std::vector<std::uint8_t> is_apart(bodies.size(), 0);
  for (const ContactSpec& contact : scene.contacts) {
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
    if (contact.tied)
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
      ContactLaw law{.first = a, .second = b, .name = bodies[first_a].name + "_" + bodies[first_b].name};
      if (const auto found = given.find({a, b}); found != given.end()) {
        const ContactSpec& contact = *found->second;
        law.friction = contact.friction, law.cohesion = contact.cohesion;
        const bool turned = contacts.field_of_body[number(contact.between[0])] != a;
        law.name = contact.between[turned ? 1 : 0] + "_" + contact.between[turned ? 0 : 1];
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

}  // namespace talus
