#include "solver/particles/migrate.hpp"

#include <algorithm>
#include <cstring>

#include "solver/halo/halo_exchange.hpp"

namespace talus {

namespace {

template <class T>
void append_bytes(const T& value, std::vector<std::byte>& to)
{
  const auto* const from = reinterpret_cast<const std::byte*>(&value);
  to.insert(to.end(), from, from + sizeof(T));
}
}  // namespace

template <int D>
Migration<D>::Migration(Communicator& ranks, const Subdomain& subdomain) : ranks_(&ranks), border_of_block_(subdomain.block.size(), none)
{
  for (const int rank : subdomain.rank_of_block)
    if (rank != subdomain.rank)
      neighbours_.push_back(rank);
  std::sort(neighbours_.begin(), neighbours_.end());
  neighbours_.erase(std::unique(neighbours_.begin(), neighbours_.end()), neighbours_.end());
  for (std::size_t b = 0; b < subdomain.block.size(); ++b)
    if (const int rank = subdomain.rank_of_block[b]; rank != subdomain.rank) {
      border_of_block_[b] = static_cast<Index>(std::lower_bound(neighbours_.begin(), neighbours_.end(), rank) - neighbours_.begin());
    }
  out_.resize(neighbours_.size());
}

template <int D>
void Migration<D>::add(const MigratingParticle::Head& head, Index block, std::span<const Real> numbers)
{
  static_assert(sizeof(head) == sizeof(Real));
  std::vector<std::byte>& message = out_[static_cast<std::size_t>(border_of_block_[static_cast<std::size_t>(block)])];
  append_bytes(head, message);
  const auto bytes = std::as_bytes(numbers);
  message.insert(message.end(), bytes.begin(), bytes.end());
  ++moved_;
}

template <int D>
void Migration<D>::receive()
{
  const auto messages = ranks_->neighbours(neighbours_, out_, static_cast<int>(MessageTag::particles));
  in_.resize(messages.size());
  for (std::size_t i = 0; i < messages.size(); ++i) {
    in_[i].resize(messages[i].size() / sizeof(Real));
    if (!messages[i].empty())
      std::memcpy(in_[i].data(), messages[i].data(), messages[i].size());
  }
  for (auto& message : out_)
    message.clear();
}

template class Migration<2>;
template class Migration<3>;

}  // namespace talus
