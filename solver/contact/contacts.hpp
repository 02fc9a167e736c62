#pragma once
// Which bodies have a velocity field of their own, and what acts between two fields where they touch.
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// What acts between two velocity fields.  Bodies that touch do not penetrate each other and do not attract each other.
struct ContactLaw {
  Index first = 0, second = 0;                                         ///< numbers of the fields, ascending
  Real friction = 0;                                                   ///< Coulomb's coefficient [-]
  Real cohesion = 0;                                                   ///< shear stress that the contact carries without pressure [Pa]
  std::string first_body, second_body;                                 ///< that stand for the fields
  std::string name() const { return first_body + "_" + second_body; }  ///< in outputs
};

/// Bodies share one velocity field unless a contact puts them apart.
struct Contacts {
  std::vector<Index> field_of_body;  ///< empty: all bodies are of field 0
  Index n_fields = 1;
  std::vector<ContactLaw> laws;  ///< ascending
  std::size_t field_of(Index body) const noexcept
  {
    return field_of_body.empty() ? 0 : static_cast<std::size_t>(field_of_body[static_cast<std::size_t>(body)]);
  }
};

}  // namespace talus
