#pragma once
// Which fields of the particles a page shows, and their values.
#include "core/field_component.hpp"
#include "io/output/vtk.hpp"

namespace talus {

/// The field of that name; nothing if the file does not have it.
const StoredField* stored_field(const StoredParticles& particles, std::string_view name);

/// One number a particle.
std::vector<Real> viewed_values(const StoredField& field, const ViewedField& viewed);

/// Of the particles of a run: those asked for; if none, the one of its pictures and then every field that was written.  Error: there is no
/// such field, or it has no such component.
std::vector<ViewedField> fields_to_show(const StoredParticles& particles, const std::vector<std::string>& asked,
                                        const std::string& of_picture);

/// "stress:xy", as it was asked for.
std::string words_of(const ViewedField& field);

}  // namespace talus
