// Messages between two ranks.
#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "core/parallel/mpi_calls.hpp"

namespace talus {

PendingMessages::PendingMessages() noexcept = default;
PendingMessages::PendingMessages(PendingMessages&&) noexcept = default;
PendingMessages& PendingMessages::operator=(PendingMessages&& other) noexcept
{
  std::swap(requests_, other.requests_);
  return *this;
}

PendingMessages::~PendingMessages()
{
  if (!requests_ || requests_->request.empty())
    return;
  // Other ranks may still read the sent bytes, which are about to be freed: wait for them, but not for ever.
  std::vector<MPI_Request>& request = requests_->request;
  if (within_patience([&](int& done) { return MPI_Testall(static_cast<int>(request.size()), request.data(), &done, MPI_STATUSES_IGNORE); }))
    return;
  for (std::size_t i = 0; i < request.size(); ++i) {
    if (request[i] == MPI_REQUEST_NULL)
      continue;
    if (i < requests_->expected.size()) {
      MPI_Cancel(&request[i]);
      MPI_Wait(&request[i], MPI_STATUS_IGNORE);
    } else {
      MPI_Request_free(&request[i]);
    }
  }
  *requests_->torn = true;
}

void PendingMessages::wait()
{
  if (!requests_ || requests_->request.empty())
    return;
  auto& [request, expected, status, torn] = *requests_;
  status.resize(request.size());
  const int result = MPI_Waitall(static_cast<int>(request.size()), request.data(), status.data());
  if (result == MPI_ERR_IN_STATUS)
    for (const MPI_Status& one : status)
      if (one.MPI_ERROR != MPI_ERR_PENDING)
        check_mpi(one.MPI_ERROR, "MPI_Waitall");
  check_mpi(result, "MPI_Waitall");
  request.clear();
  for (std::size_t i = 0; i < expected.size(); ++i) {
    int bytes = 0;
    check_mpi(MPI_Get_count(&status[i], MPI_BYTE, &bytes), "MPI_Get_count");
    if (bytes != expected[i].bytes && !expected[i].at_most)
      throw EnvironmentError(
          fmt::format("a message from rank {} has {} bytes where {} were expected", expected[i].rank, bytes, expected[i].bytes));
  }
}

void Communicator::count(int tag, int bytes) noexcept
{
  if (tag >= tags) {  // part of a collective
    traffic_.bytes_gathered += bytes;
    return;
  }
  traffic_.messages += 1;
  traffic_.bytes += bytes;
}

void Communicator::start(std::span<const Message> out, std::span<const Message> in, int tag, PendingMessages& pending)
{
  assert(tag >= 0 && tag < tags);
  post(out, in, tag, pending);
}

void Communicator::post(std::span<const Message> out, std::span<const Message> in, int tag, PendingMessages& pending)
{
  if (alone()) {
    for (std::size_t i = 0; i < std::max(out.size(), in.size()); ++i) {
      if (i >= out.size() || i >= in.size() || out[i].rank != 0 || in[i].rank != 0 || out[i].bytes.size() != in[i].bytes.size())
        throw EnvironmentError(fmt::format("message {} of a rank that is alone is not from itself to itself", i + 1));
      std::ranges::copy(out[i].bytes, in[i].bytes.begin());
    }
    return;
  }
  if (!pending.requests_)
    pending.requests_ = std::make_unique<PendingMessages::Requests>();
  PendingMessages::Requests& requests = *pending.requests_;
  assert(requests.request.empty());  // or it was not followed by wait()
  requests.expected.clear();
  requests.torn = &group_->torn;
  const auto in_pieces = [this](std::span<std::byte> bytes, auto&& f) {
    for (; !bytes.empty(); bytes = bytes.subspan(std::min(piece_, bytes.size())))
      f(bytes.first(std::min(piece_, bytes.size())));
  };
  for (const Message& one_message : in)
    if (one_message.at_most && one_message.bytes.size() > piece_)
      throw EnvironmentError(
          fmt::format("a message of up to {} bytes from rank {} is too long", one_message.bytes.size(), one_message.rank));
  for (const Message& one_message : in)
    in_pieces(one_message.bytes, [&, rank = one_message.rank, at_most = one_message.at_most](std::span<std::byte> piece) {
      const int bytes = static_cast<int>(piece.size());
      MPI_Request one = MPI_REQUEST_NULL;
      check_mpi(MPI_Irecv(piece.data(), bytes, MPI_BYTE, rank, tag, group_->comm, &one), "MPI_Irecv");
      requests.request.push_back(one);
      requests.expected.push_back({rank, bytes, at_most});
    });
  for (const Message& one_message : out)
    in_pieces(one_message.bytes, [&, rank = one_message.rank](std::span<std::byte> piece) {
      const int bytes = static_cast<int>(piece.size());
      MPI_Request one = MPI_REQUEST_NULL;
      check_mpi(MPI_Isend(piece.data(), bytes, MPI_BYTE, rank, tag, group_->comm, &one), "MPI_Isend");
      requests.request.push_back(one);
      count(tag, bytes);
    });
}

std::vector<std::vector<std::byte>> Communicator::neighbours(std::span<const int> ranks, const std::vector<std::vector<std::byte>>& out,
                                                             int tag)
{
  assert(ranks.size() == out.size() && tag >= 0 && tag < tags);
  if (alone()) {
    if (std::ranges::any_of(ranks, [](int r) { return r != 0; }))
      throw EnvironmentError("a rank that is alone has no neighbour but itself");
    return out;
  }
  // A message of exactly one full piece is followed by another one, which may be empty.
  PendingMessages pending;
  pending.requests_ = std::make_unique<PendingMessages::Requests>();
  pending.requests_->torn = &group_->torn;
  for (std::size_t i = 0; i < ranks.size(); ++i)
    for (std::size_t begin = 0; begin <= out[i].size(); begin += piece_) {
      const int bytes = static_cast<int>(std::min(piece_, out[i].size() - begin));
      MPI_Request one = MPI_REQUEST_NULL;
      check_mpi(MPI_Isend(out[i].data() + begin, bytes, MPI_BYTE, ranks[i], tag, group_->comm, &one), "MPI_Isend");
      pending.requests_->request.push_back(one);
      count(tag, bytes);
    }
  std::vector<std::vector<std::byte>> in(ranks.size());
  for (std::size_t i = 0; i < ranks.size(); ++i)
    for (int bytes = static_cast<int>(piece_); static_cast<std::size_t>(bytes) == piece_;) {
      MPI_Message message = MPI_MESSAGE_NULL;
      MPI_Status status;
      check_mpi(MPI_Mprobe(ranks[i], tag, group_->comm, &message, &status), "MPI_Mprobe");
      check_mpi(MPI_Get_count(&status, MPI_BYTE, &bytes), "MPI_Get_count");
      const std::size_t begin = in[i].size();
      in[i].resize(begin + static_cast<std::size_t>(bytes));
      check_mpi(MPI_Mrecv(in[i].data() + begin, bytes, MPI_BYTE, &message, MPI_STATUS_IGNORE), "MPI_Mrecv");
    }
  pending.wait();
  return in;
}

}  // namespace talus
