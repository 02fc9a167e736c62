#include "materials/batch.hpp"

#include <cassert>

#include "core/parallel/threads.hpp"

namespace talus {

void permute(AnyBatch& batch, std::span<const Index> order)
{
  std::visit(
      [&](auto& typed) {
        assert(order.size() == typed.history.size());
        typed.scratch.resize(typed.history.size());
        parallel_for(static_cast<Index>(order.size()), [&](Index i) {
          typed.scratch[static_cast<std::size_t>(i)] = typed.history[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])];
        });
        std::swap(typed.history, typed.scratch);
      },
      batch);
}

bool prestress(AnyBatch& batch, Index i, const Mat3& stress) noexcept
{
  return std::visit([&](auto& typed) { return prestress(typed, i, stress); }, batch);
}

Real plastic_work(const AnyBatch& batch, Index i, Real volume0)
{
  Real work = 0;
  for_each_history(batch, [&](std::string_view key, std::string_view, std::string_view, const auto& column) {
    if constexpr (std::decay_t<decltype(column)>::components == 1)
      if (key == "plastic_work")
        work = volume0 * column[i];
  });
  return work;
}

Real density(const AnyBatch& batch) noexcept
{
  return std::visit([](const auto& typed) { return typed.law.density; }, batch);
}

Real wave_speed(const AnyBatch& batch, const Mat3& F) noexcept
{
  return std::visit([&](const auto& typed) { return typed.law.wave_speed(F, typed.constants); }, batch);
}

bool averages_volume(const AnyBatch& batch) noexcept
{
  return std::visit([](const auto& typed) { return typed.averages_volume; }, batch);
}

Index averages_with(const AnyBatch& batch) noexcept
{
  return std::visit([](const auto& typed) { return typed.averages_volume ? typed.averages_with : none; }, batch);
}

bool has_bulk_viscosity(const AnyBatch& batch) noexcept
{
  return std::visit([](const auto& typed) { return typed.viscosity.has_value(); }, batch);
}

bool conducts_heat(const AnyBatch& batch) noexcept
{
  return std::visit(
      [](const auto& typed) {
        if constexpr (requires { typed.law.conductivity; })
          return typed.law.conductivity.has_value();
        return false;
      },
      batch);
}

std::string_view law_name(const AnyBatch& batch) noexcept
{
  return std::visit([](const auto& typed) { return std::string_view{std::decay_t<decltype(typed.law)>::name}; }, batch);
}

}  // namespace talus
