#include "app/observers/frame.hpp"

#include "app/observers/field_columns.hpp"
#include "app/observers/rank_slices.hpp"

namespace talus {

template <int D>
Frame::ParticleFile particles_of_frame(const RunView<D>& view, const OutputSpec& outputs, std::filesystem::path file)
{
  Frame::ParticleFile part{std::move(file), {}, {}, {}, {}};
  on_slices(view, [&](const State<D>& slice, const std::vector<Body>&, const Slice& of_file) {
    const auto rows = rows_by_id(slice.particles);
    for (const std::string& name : particle_fields_of(outputs))
      part.columns.push_back(particle_column(view.problem, slice, rows, name));
    part.ids.reserve(rows.size());
    for (const Index row : rows)
      part.ids.push_back(slice.particles.id[static_cast<std::size_t>(row)]);
    part.positions = positions(slice.particles, rows);
    part.rows = of_file;
  });
  return part;
}

template <int D>
Frame::MeshFile mesh_of_frame(const RunView<D>& view, const OutputSpec& outputs, std::filesystem::path file)
{
  Frame::MeshFile part{std::move(file), slice_of_mesh(view), {}};
  for (const std::string& name : outputs.mesh->fields_wanted)
    part.columns.push_back(slice_of_column(view, node_column(view, name)));
  return part;
}

template Frame::ParticleFile particles_of_frame<2>(const RunView<2>&, const OutputSpec&, std::filesystem::path);
template Frame::ParticleFile particles_of_frame<3>(const RunView<3>&, const OutputSpec&, std::filesystem::path);
template Frame::MeshFile mesh_of_frame<2>(const RunView<2>&, const OutputSpec&, std::filesystem::path);
template Frame::MeshFile mesh_of_frame<3>(const RunView<3>&, const OutputSpec&, std::filesystem::path);

}  // namespace talus
