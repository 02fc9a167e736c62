#include "core/parallel/communicator.hpp"

#include <fmt/format.h>
#define OMPI_SKIP_MPICXX 1  // NOLINT(readability-identifier-naming): MPI's name for leaving out its old C++ classes
#include <mpi.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <new>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "core/error.hpp"

namespace talus {

struct Communicator::Group {
  Group()
  {
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);  // which the copy inherits
    if (MPI_Comm_dup(MPI_COMM_WORLD, &comm) != MPI_SUCCESS)
      throw EnvironmentError("MPI_Comm_dup failed");
  }
  Group(const Group&) = delete;
  Group& operator=(const Group&) = delete;
  ~Group() { MPI_Comm_free(&comm); }

  MPI_Comm comm = MPI_COMM_NULL;
  bool torn = false;  ///< messages were called off: MPI_Finalize might wait for them
};

struct PendingMessages::Requests {
  struct Expected {
    int rank, bytes;
    bool at_most;
  };
  std::vector<MPI_Request> request;  ///< of receipts, then of what is sent
  std::vector<Expected> expected;    ///< of each receipt
  std::vector<MPI_Status> status;
  bool* torn = nullptr;
};

namespace {

constexpr int gather_tag = Communicator::tags, all_to_all_tag = Communicator::tags + 1;

void check(int result, const char* call)
{
  if (result == MPI_SUCCESS)
    return;
  std::array<char, MPI_MAX_ERROR_STRING> text{};
  int length = 0;
  MPI_Error_string(result, text.data(), &length);
  throw EnvironmentError(fmt::format("{} failed: {}", call, std::string_view(text.data(), static_cast<std::size_t>(length))));
}

/// What launchers tell each rank: Open MPI, MPICH, PMIx.
constexpr std::array launch_variables{"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMI_RANK", "PMIX_RANK"};

bool in_environment(const char* name)
{
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0';
}

/// How many ranks the launcher says that it has started.
std::optional<int> launched()
{
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"})
    if (in_environment(name))
      return std::atoi(std::getenv(name));
  return std::nullopt;
}

/// Whether what test(done) asks MPI about gets done in the time in which ranks that fail alike, one sooner than the other, come to it.
template <class F>
bool within_patience(F&& test)
{
  const auto last = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  for (;;) {
    int done = 0;
    if (test(done) != MPI_SUCCESS)
      return false;
    if (done != 0)
      return true;
    if (std::chrono::steady_clock::now() > last)
      return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

/// Integers in the order of the doubles, NaN before all.  Without NaN it is its own inverse.
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

// An error as text, and back.

enum class Kind : char { scene = 's', run = 'r', stopped = 't', environment = 'e', other = 'o', memory = 'm', foreign = 'f' };

void put(std::string_view part, std::string& text) { text += fmt::format("{} {}", part.size(), part); }

std::string take(std::string_view& text)
{
  const std::size_t space = text.find(' ');
  const std::size_t length = std::stoul(std::string(text.substr(0, space)));
  std::string part(text.substr(space + 1, length));
  text.remove_prefix(space + 1 + length);
  return part;
}

std::string packed(Kind kind, std::string_view message)
{
  std::string text(1, static_cast<char>(kind));
  put(message, text);
  return text;
}

std::string packed(const std::exception_ptr& error)
{
  try {
    std::rethrow_exception(error);
  } catch (const SceneErrors& e) {
    std::string text(1, static_cast<char>(Kind::scene));
    for (const auto& [where, message, source_line] : e.problems())
      for (const std::string& part :
           {where.file, std::to_string(where.line), std::to_string(where.column), where.path, message, source_line})
        put(part, text);
    return text;
  } catch (const RunError& e) {
    return packed(Kind::run, e.what());
  } catch (const Stopped& e) {
    return packed(Kind::stopped, e.what());
  } catch (const EnvironmentError& e) {
    return packed(Kind::environment, e.what());
  } catch (const Error& e) {
    return packed(Kind::other, e.what());
  } catch (const std::bad_alloc& e) {
    return packed(Kind::memory, e.what());
  } catch (const std::exception& e) {
    return packed(Kind::foreign, e.what());
  } catch (...) {
    return packed(Kind::foreign, "an exception of an unknown kind");
  }
}

[[noreturn]] void throw_packed(std::string_view text)
{
  const auto kind = static_cast<Kind>(text.front());
  text.remove_prefix(1);
  if (kind == Kind::scene) {
    std::vector<SceneError> problems;
    while (!text.empty()) {
      SceneError& problem = problems.emplace_back();
      problem.where.file = take(text);
      problem.where.line = std::stoi(take(text));
      problem.where.column = std::stoi(take(text));
      problem.where.path = take(text);
      problem.message = take(text);
      problem.source_line = take(text);
    }
    throw SceneErrors(std::move(problems));
  }
  const std::string message = take(text);
  switch (kind) {
    case Kind::run: throw RunError(message);
    case Kind::stopped: throw Stopped(message);
    case Kind::environment: throw EnvironmentError(message);
    case Kind::other: throw Error(message);
    case Kind::memory: throw std::bad_alloc();
    default: throw std::runtime_error(message);
  }
}

}  // namespace

bool launched_as_ranks() { return std::ranges::any_of(launch_variables, in_environment); }

void forget_launch() noexcept
{
  for (const char* const name : launch_variables)
    ::unsetenv(name);
}

int ranks_on_this_machine()
{
  for (const char* const name : {"OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS", "SLURM_NTASKS_PER_NODE"})
    if (const char* const text = std::getenv(name))
      return std::max(1, std::atoi(text));
  return 1;
}

// ---- messages between two ranks

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
  // Others may be reading what was sent, and its bytes are about to go: a wait, but not for what never comes.
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
        check(one.MPI_ERROR, "MPI_Waitall");
  check(result, "MPI_Waitall");
  request.clear();
  for (std::size_t i = 0; i < expected.size(); ++i) {
    int bytes = 0;
    check(MPI_Get_count(&status[i], MPI_BYTE, &bytes), "MPI_Get_count");
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

void Communicator::start(std::span<const Message> out, std::span<const Message> in, int tag, PendingMessages& talk)
{
  assert(tag >= 0 && tag < tags);
  post(out, in, tag, talk);
}

void Communicator::post(std::span<const Message> out, std::span<const Message> in, int tag, PendingMessages& talk)
{
  if (alone()) {
    for (std::size_t i = 0; i < std::max(out.size(), in.size()); ++i) {
      if (i >= out.size() || i >= in.size() || out[i].rank != 0 || in[i].rank != 0 || out[i].bytes.size() != in[i].bytes.size())
        throw EnvironmentError(fmt::format("message {} of a rank that is alone is not from itself to itself", i + 1));
      std::ranges::copy(out[i].bytes, in[i].bytes.begin());
    }
    return;
  }
  if (!talk.requests_)
    talk.requests_ = std::make_unique<PendingMessages::Requests>();
  PendingMessages::Requests& requests = *talk.requests_;
  assert(requests.request.empty());  // or it has not been waited for
  requests.expected.clear();
  requests.torn = &group_->torn;
  const auto in_pieces = [this](std::span<std::byte> bytes, auto&& f) {
    for (; !bytes.empty(); bytes = bytes.subspan(std::min(piece_, bytes.size())))
      f(bytes.first(std::min(piece_, bytes.size())));
  };
  for (const Message& parcel : in)
    if (parcel.at_most && parcel.bytes.size() > piece_)
      throw EnvironmentError(fmt::format("a message of up to {} bytes from rank {} is too long", parcel.bytes.size(), parcel.rank));
  for (const Message& parcel : in)
    in_pieces(parcel.bytes, [&, rank = parcel.rank, at_most = parcel.at_most](std::span<std::byte> piece) {
      const int bytes = static_cast<int>(piece.size());
      MPI_Request one = MPI_REQUEST_NULL;
      check(MPI_Irecv(piece.data(), bytes, MPI_BYTE, rank, tag, group_->comm, &one), "MPI_Irecv");
      requests.request.push_back(one);
      requests.expected.push_back({rank, bytes, at_most});
    });
  for (const Message& parcel : out)
    in_pieces(parcel.bytes, [&, rank = parcel.rank](std::span<std::byte> piece) {
      const int bytes = static_cast<int>(piece.size());
      MPI_Request one = MPI_REQUEST_NULL;
      check(MPI_Isend(piece.data(), bytes, MPI_BYTE, rank, tag, group_->comm, &one), "MPI_Isend");
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
  // A message of a full piece says that another follows, be it empty.
  PendingMessages talk;
  talk.requests_ = std::make_unique<PendingMessages::Requests>();
  talk.requests_->torn = &group_->torn;
  for (std::size_t i = 0; i < ranks.size(); ++i)
    for (std::size_t begin = 0; begin <= out[i].size(); begin += piece_) {
      const int bytes = static_cast<int>(std::min(piece_, out[i].size() - begin));
      MPI_Request one = MPI_REQUEST_NULL;
      check(MPI_Isend(out[i].data() + begin, bytes, MPI_BYTE, ranks[i], tag, group_->comm, &one), "MPI_Isend");
      talk.requests_->request.push_back(one);
      count(tag, bytes);
    }
  std::vector<std::vector<std::byte>> in(ranks.size());
  for (std::size_t i = 0; i < ranks.size(); ++i)
    for (int bytes = static_cast<int>(piece_); static_cast<std::size_t>(bytes) == piece_;) {
      MPI_Message message = MPI_MESSAGE_NULL;
      MPI_Status status;
      check(MPI_Mprobe(ranks[i], tag, group_->comm, &message, &status), "MPI_Mprobe");
      check(MPI_Get_count(&status, MPI_BYTE, &bytes), "MPI_Get_count");
      const std::size_t begin = in[i].size();
      in[i].resize(begin + static_cast<std::size_t>(bytes));
      check(MPI_Mrecv(in[i].data() + begin, bytes, MPI_BYTE, &message, MPI_STATUS_IGNORE), "MPI_Mrecv");
    }
  talk.wait();
  return in;
}

// ---- collectives

void Communicator::reduce(std::span<std::int64_t> numbers, Reduction reduction)
{
  if (alone())
    return;
  const std::size_t most = std::max<std::size_t>(piece_ / sizeof(std::int64_t), 1);
  for (; !numbers.empty(); numbers = numbers.subspan(std::min(most, numbers.size()))) {
    const auto count = static_cast<int>(std::min(most, numbers.size()));
    check(MPI_Allreduce(MPI_IN_PLACE, numbers.data(), count, MPI_INT64_T, reduction == Reduction::sum ? MPI_SUM : MPI_MIN, group_->comm),
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

  // First how many ranks have something beyond the digits that were in use up to now.
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

  // Some have: all words, and from now on the digits that any rank has used, and one more at either end.
  std::vector<std::int64_t> ends;
  for (std::size_t i = 0; i < n; ++i) {
    const auto words = words_of(i);
    const auto first = std::find_if_not(words.begin(), words.end(), is_zero);
    const auto last = std::find_if_not(words.rbegin(), std::make_reverse_iterator(first), is_zero).base();
    const bool is_used = first != words.end();
    ends.push_back(is_used ? first - words.begin() : each);
    ends.push_back(is_used ? words.begin() - last : 0);
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
  check(MPI_Bcast(&length, 1, MPI_INT64_T, from, group_->comm), "MPI_Bcast");
  bytes.resize(static_cast<std::size_t>(length));
  for (std::size_t begin = 0; begin < bytes.size(); begin += piece_) {
    const auto count = static_cast<int>(std::min(piece_, bytes.size() - begin));
    check(MPI_Bcast(bytes.data() + begin, count, MPI_BYTE, from, group_->comm), "MPI_Bcast");
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
  check(MPI_Gather(&length, 1, MPI_INT64_T, lengths.data(), 1, MPI_INT64_T, 0, group_->comm), "MPI_Gather");
  std::vector<std::vector<std::byte>> all;
  std::vector<Message> in;
  for (const std::int64_t n : lengths)
    all.emplace_back(static_cast<std::size_t>(n));
  for (int r = 0; r < static_cast<int>(all.size()); ++r)
    in.push_back({r, all[static_cast<std::size_t>(r)]});
  const Message mine{0, {const_cast<std::byte*>(bytes.data()), bytes.size()}};  // read only
  PendingMessages talk;
  post({&mine, 1}, in, gather_tag, talk);
  talk.wait();
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
  check(MPI_Alltoall(lengths_out.data(), 1, MPI_INT64_T, lengths_in.data(), 1, MPI_INT64_T, group_->comm), "MPI_Alltoall");
  std::vector<std::vector<std::byte>> in;
  std::vector<Message> parcels_out, parcels_in;
  for (const std::int64_t n : lengths_in)
    in.emplace_back(static_cast<std::size_t>(n));
  for (int r = 0; r < size(); ++r) {
    const auto i = static_cast<std::size_t>(r);
    parcels_out.push_back({r, {const_cast<std::byte*>(out[i].data()), out[i].size()}});  // read only
    parcels_in.push_back({r, in[i]});
  }
  PendingMessages talk;
  post(parcels_out, parcels_in, all_to_all_tag, talk);
  talk.wait();
  return in;
}

void Communicator::barrier()
{
  if (!alone())
    check(MPI_Barrier(group_->comm), "MPI_Barrier");
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

void Communicator::abort(int code) const noexcept
{
  std::fflush(nullptr);
  if (group_)
    MPI_Abort(MPI_COMM_WORLD, code);
  std::_Exit(code);
}

// ---- beginning and end

Communicator::Communicator() noexcept = default;
Communicator::Communicator(Communicator&&) noexcept = default;
Communicator& Communicator::operator=(Communicator&&) noexcept = default;
Communicator::~Communicator() = default;
Communicator::Communicator(std::unique_ptr<Group> group) noexcept : group_(std::move(group))
{
  MPI_Comm_rank(group_->comm, &rank_);
  MPI_Comm_size(group_->comm, &size_);
}

Communicator& one_rank()
{
  static Communicator exchange;
  return exchange;
}

Communicator& world()
{
  static Communicator exchange;
  return exchange;
}

bool goes_on_as_root()
{
  const bool is_root = world().is_root();
  world() = Communicator();
  return is_root;
}

Ranks::Ranks()
{
  if (!launched_as_ranks())
    return;
  int level = MPI_THREAD_SINGLE;
  check(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &level), "MPI_Init_thread");
  running_ = true;
  world() = Communicator(std::make_unique<Communicator::Group>());
  const int found = world().size();
  std::string wrong;
  if (level < MPI_THREAD_FUNNELED)
    wrong = "this MPI cannot be used by a program with threads (MPI_THREAD_FUNNELED)";
  else if (launched().value_or(found) != found)
    wrong = fmt::format("the launcher has started {} ranks, MPI finds {}: the program was built with another MPI than the launcher's",
                        *launched(), found);
  if (!wrong.empty()) {
    end(0);
    throw EnvironmentError(wrong);
  }
}

int Ranks::end(int code, const char* message) noexcept
{
  const int rank = world().rank();
  const auto say = [&] {
    std::fflush(stdout);
    if (message != nullptr && rank == 0)
      std::fprintf(stderr, "%s\n", message);
    else if (message != nullptr)
      std::fprintf(stderr, "rank %d: %s\n", rank, message);
  };
  if (rank == 0)
    say();
  if (!std::exchange(running_, false))
    return code;
  MPI_Request all_here = MPI_REQUEST_NULL;
  MPI_Ibarrier(MPI_COMM_WORLD, &all_here);  // not among the collectives that others may be waiting in
  if (code == 0) {
    for (int done = 0; MPI_Test(&all_here, &done, MPI_STATUS_IGNORE) == MPI_SUCCESS && done == 0;)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  } else if (!within_patience([&](int& done) { return MPI_Test(&all_here, &done, MPI_STATUS_IGNORE); })) {
    if (rank != 0)
      say();
    world().abort(code);
  }
  if (world().group_ && world().group_->torn)
    world().abort(code);
  world() = Communicator();
  MPI_Finalize();
  return code;
}

Ranks::~Ranks() { end(std::uncaught_exceptions() > 0 ? 1 : 0); }

}  // namespace talus
