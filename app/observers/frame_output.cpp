#include "app/observers/frame_output.hpp"

#include <memory>

namespace talus {

FrameOutput::FrameOutput(const std::filesystem::path& folder, const std::string& made_by)
    : made_by_(made_by),
      particle_series_(folder / "particles.pvd", made_by),
      mesh_series_(folder / "mesh.pvd", made_by),
      rigid_series_(folder / "rigid.pvd", made_by)
{}

void FrameOutput::write(Communicator& ranks, Frame frame)
{
  wait();
  written_.clear();
  pending_ = true;
  if (!ranks.alone())
    return write_now(ranks, frame);
  // A shared pointer, because work that can be stored has to be copyable.
  task_.start([this, kept = std::make_shared<const Frame>(std::move(frame))] {
    Communicator alone;  // one_rank() belongs to the main thread
    write_now(alone, *kept);
  });
}

void FrameOutput::write_now(Communicator& ranks, const Frame& frame)
{
  if (const auto& part = frame.particles) {
    write_particles(ranks, part->file, frame.time, part->rows, part->positions, part->ids, part->columns, made_by_);
    ranks.together([&] { particle_series_.append(frame.time, part->file); });
    written_.push_back(part->file.filename().string());
  }
  if (const auto& part = frame.mesh) {
    write_mesh(ranks, part->file, frame.time, part->mesh, part->columns, {}, made_by_);
    ranks.together([&] { mesh_series_.append(frame.time, part->file); });
    written_.push_back(part->file.filename().string());
  }
  if (const auto& part = frame.rigid) {
    ranks.together([&] {
      Communicator alone;
      write_mesh(alone, part->file, frame.time, part->mesh, part->columns, {}, made_by_);
      rigid_series_.append(frame.time, part->file);
    });
    written_.push_back(part->file.filename().string());
  }
}

void FrameOutput::resume(Real time)
{
  for (PvdSeries* const series : {&particle_series_, &mesh_series_, &rigid_series_})
    series->resume(time);
}

void FrameOutput::wait()
{
  pending_ = false;
  task_.wait();
}

}  // namespace talus
