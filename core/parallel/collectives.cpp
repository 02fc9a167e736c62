// Collective calls of the communicator.
#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "core/parallel/mpi_calls.hpp"
#include "core/parallel/packed_error.hpp"

namespace talus {

namespace {

/// Maps doubles to integers of the same order, NaN before all.  Without NaN the map is its own inverse.
std::int64_t ordered(Real x)
{
  if (std::isnan(x))
    return std::numeric_limits<std::int64_t>::min();
  const auto bits = std::bit_cast<std::int64_t>(x);
  return bits < 0 ? bits ^ std::numeric_limits<std::int64_t>::max() : bits;
}
Real number_of(std::int64_t ordered)
{
  if (ordered == std::numeric_limits<std::int64_t>::min())
    return std::numeric_limits<Real>::quiet_NaN();
  return std::bit_cast<Real>(ordered < 0 ? ordered ^ std::numeric_limits<std::int64_t>::max() : ordered);
}

}  // namespace

void Communicator::reduce(std::span<std::int64_t> numbers, Reduction reduction)
{
  if (alone())
    return;
  const std::size_t most = std::max<std::size_t>(piece_ / sizeof(std::int64_t), 1);
  for (; !numbers.empty(); numbers = numbers.subspan(std::min(most, numbers.size()))) {
    const auto count = static_cast<int>(std::min(most, numbers.size()));
    check_mpi(
        MPI_Allreduce(MPI_IN_PLACE, numbers.data(), count, MPI_INT64_T, reduction == Reduction::sum ? MPI_SUM : MPI_MIN, group_->comm),
        "MPI_Allreduce");
    traffic_.calls += 1;
    traffic_.bytes_to_all += std::int64_t{count} * static_cast<std::int64_t>(sizeof(std::int64_t));
  }
}

void Communicator::sum(std::span<std::int64_t> numbers) { reduce(numbers, Reduction::sum); }

std::int64_t Communicator::min(std::int64_t number)
{
  reduce({&number, 1}, Reduction::min);
  return number;
}

Real Communicator::min(Real number) { return alone() ? number : number_of(min(ordered(number))); }

void Communicator::least(std::span<Real> numbers, std::int64_t& word)
{
  if (alone())
    return;
  words_.resize(numbers.size() + 1);
  std::ranges::transform(numbers, words_.begin(), ordered);
  words_.back() = word;
  reduce(words_, Reduction::min);
  word = words_.back();
  std::transform(words_.begin(), words_.end() - 1, numbers.begin(), number_of);
}

void Communicator::sum_in_use(Digits& digits)
{
  constexpr auto each = static_cast<std::int64_t>(ExactSum::words);
  const std::size_t n = words_.size() / ExactSum::words;
  digits.of_sum_.resize(n, {each, 0});
  const auto words_of = [&](std::size_t i) { return std::span(words_).subspan(i * ExactSum::words, ExactSum::words); };

  // First count the ranks that have digits outside the range that was in use up to now.
  std::vector<std::int64_t>& packed = digits.packed_;
  packed.assign(1, 0);
  const auto is_zero = [](std::int64_t word) { return word == 0; };
  for (std::size_t i = 0; i < n; ++i) {
    const auto words = words_of(i);
    const auto [lowest, behind] = digits.of_sum_[i];
    const auto first = words.begin() + std::min(lowest, behind), last = words.begin() + behind;
    if (!std::all_of(words.begin(), first, is_zero) || !std::all_of(last, words.end(), is_zero))
      packed.front() = 1;
    packed.insert(packed.end(), first, last);
  }
  reduce(packed, Reduction::sum);
  if (packed.front() == 0) {
    auto from = packed.begin() + 1;
    for (std::size_t i = 0; i < n; ++i) {
      const auto words = words_of(i);
      std::fill(words.begin(), words.end(), 0);
      const auto [lowest, behind] = digits.of_sum_[i];
      if (const std::int64_t count = behind - lowest; count > 0)
        std::copy_n(std::exchange(from, from + count), count, words.begin() + lowest);
    }
    return;
  }

  // Some ranks have: send all words, and from now on the digits that any rank has used, and one more at either end.
  std::vector<std::int64_t> ends;
  for (std::size_t i = 0; i < n; ++i) {
    const auto words = words_of(i);
    const auto first = std::find_if_not(words.begin(), words.end(), is_zero);
    const auto last = std::find_if_not(words.rbegin(), std::make_reverse_iterator(first), is_zero).base();
    const bool used = first != words.end();
    ends.push_back(used ? first - words.begin() : each);
    ends.push_back(used ? words.begin() - last : 0);
  }
  reduce(ends, Reduction::min);
  for (std::size_t i = 0; i < n; ++i)
    if (auto& [lowest, behind] = digits.of_sum_[i]; ends[2 * i] < each) {
      lowest = std::min(lowest, std::max<std::int64_t>(ends[2 * i] - 1, 0));
      behind = std::max(behind, std::min(-ends[2 * i + 1] + 1, each));
    }
  reduce(words_, Reduction::sum);
}

template <class Bytes>
void Communicator::spread(Bytes& bytes, int from)
{
  if (alone())
    return;
  auto length = static_cast<std::int64_t>(bytes.size());
  check_mpi(MPI_Bcast(&length, 1, MPI_INT64_T, from, group_->comm), "MPI_Bcast");
  bytes.resize(static_cast<std::size_t>(length));
  for (std::size_t begin = 0; begin < bytes.size(); begin += piece_) {
    const auto count = static_cast<int>(std::min(piece_, bytes.size() - begin));
    check_mpi(MPI_Bcast(bytes.data() + begin, count, MPI_BYTE, from, group_->comm), "MPI_Bcast");
  }
  if (rank() == from) {
    traffic_.calls += 1;
    traffic_.bytes_to_all += length;
  }
}

void Communicator::broadcast(std::vector<std::byte>& bytes, int from) { spread(bytes, from); }
void Communicator::broadcast(std::string& text, int from) { spread(text, from); }

std::string Communicator::first(std::string text)
{
  const auto from = static_cast<int>(min(static_cast<std::int64_t>(text.empty() ? size() : rank())));
  if (from < size())
    broadcast(text, from);
  return text;
}

std::vector<std::vector<std::byte>> Communicator::gather(std::span<const std::byte> bytes)
{
  if (alone())
    return {{bytes.begin(), bytes.end()}};
  const auto length = static_cast<std::int64_t>(bytes.size());
  std::vector<std::int64_t> lengths(is_root() ? static_cast<std::size_t>(size()) : 0);
  check_mpi(MPI_Gather(&length, 1, MPI_INT64_T, lengths.data(), 1, MPI_INT64_T, 0, group_->comm), "MPI_Gather");
  std::vector<std::vector<std::byte>> all;
  std::vector<Message> in;
  for (const std::int64_t n : lengths)
    all.emplace_back(static_cast<std::size_t>(n));
  for (int r = 0; r < static_cast<int>(all.size()); ++r)
    in.push_back({r, all[static_cast<std::size_t>(r)]});
  const Message mine{0, {const_cast<std::byte*>(bytes.data()), bytes.size()}};  // read only
  PendingMessages pending;
  post({&mine, 1}, in, gather_tag, pending);
  pending.wait();
  return all;
}

std::vector<std::vector<std::byte>> Communicator::all_to_all(const std::vector<std::vector<std::byte>>& out)
{
  assert(out.size() == static_cast<std::size_t>(size()));
  if (alone())
    return out;
  std::vector<std::int64_t> lengths_out, lengths_in(out.size());
  for (const auto& bytes : out)
    lengths_out.push_back(static_cast<std::int64_t>(bytes.size()));
  check_mpi(MPI_Alltoall(lengths_out.data(), 1, MPI_INT64_T, lengths_in.data(), 1, MPI_INT64_T, group_->comm), "MPI_Alltoall");
  std::vector<std::vector<std::byte>> in;
  std::vector<Message> parcels_out, parcels_in;
  for (const std::int64_t n : lengths_in)
    in.emplace_back(static_cast<std::size_t>(n));
  for (int r = 0; r < size(); ++r) {
    const auto i = static_cast<std::size_t>(r);
    parcels_out.push_back({r, {const_cast<std::byte*>(out[i].data()), out[i].size()}});  // read only
    parcels_in.push_back({r, in[i]});
  }
  PendingMessages pending;
  post(parcels_out, parcels_in, all_to_all_tag, pending);
  pending.wait();
  return in;
}

void Communicator::barrier()
{
  if (!alone())
    check_mpi(MPI_Barrier(group_->comm), "MPI_Barrier");
}

void Communicator::agree(const std::exception_ptr& error)
{
  const std::int64_t first = min(std::int64_t{error ? rank() : size()});
  if (first == size())
    return;
  if (alone())
    std::rethrow_exception(error);
  std::string text = first == rank() ? packed(error) : std::string();
  broadcast(text, static_cast<int>(first));
  if (first == rank())
    std::rethrow_exception(error);
  throw_packed(text);
}

}  // namespace talus
