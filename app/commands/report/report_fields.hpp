#pragma once
// The fields of particles that a page shows.
#include "core/field_component.hpp"
#include "io/output/vtk.hpp"

namespace talus {

/// The fields to show: the requested ones, or else the one of the pictures and then every field that was written.  Throws Error if a field
/// or component does not exist.
std::vector<ViewedField> fields_to_show(const StoredParticles& particles, const std::vector<std::string>& asked,
                                        const std::string& of_picture);

/// The field as the user names it, such as "stress:xy".
std::string words_of(const ViewedField& field);

}  // namespace talus
