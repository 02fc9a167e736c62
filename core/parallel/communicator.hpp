#pragma once
// Communication between the ranks of a run; the only code that calls MPI.  Exact sums and sums of integers are bitwise identical for any
// number of ranks.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/parallel/exact_sum.hpp"
#include "core/types.hpp"

namespace talus {

/// Whether the environment says that a launcher (mpirun, srun with PMI or PMIx) has started this process as one of several.
bool launched_as_ranks();

/// Removes the variables of the launcher from the environment, so that programs started by this process do not take themselves for ranks.
void forget_launch() noexcept;

/// The number of ranks on this machine according to the environment of the launcher; 1 if unknown.
int ranks_on_this_machine();

/// The amount of data that this rank has sent so far.
struct Traffic {
  std::int64_t messages = 0, bytes = 0;      ///< messages to single ranks
  std::int64_t calls = 0, bytes_to_all = 0;  ///< sums, minima and broadcasts, and the bytes that this rank contributed
  std::int64_t bytes_gathered = 0;           ///< bytes of gather() and all_to_all(), used for set-up and files
};

/// The range of digits in use of exact sums that are repeated every step.  Only these digits are sent, as most digits of an ExactSum are
/// zero.  All ranks have the same range, which never shrinks.
class Digits {
  friend class Communicator;
  struct Range {
    std::int64_t lowest, behind;  ///< words of an ExactSum, [lowest, behind); empty unless behind is larger
  };
  std::vector<Range> of_sum_;
  std::vector<std::int64_t> packed_;
};

/// The number of words of an ExactSums or a span of them.
template <class T>
std::size_t words_in(const ExactSums<T>&) noexcept
{
  return ExactSums<T>::words;
}
template <class T>
std::size_t words_in(std::span<ExactSums<T>> sums) noexcept
{
  return sums.size() * ExactSums<T>::words;
}
template <class T>
void write_words(const ExactSums<T>& sum, std::span<std::int64_t> to)
{
  sum.write(to);
}
template <class T>
void write_words(std::span<ExactSums<T>> sums, std::span<std::int64_t> to)
{
  for (std::size_t i = 0; i < sums.size(); ++i)
    sums[i].write(to.subspan(i * ExactSums<T>::words, ExactSums<T>::words));
}
template <class T>
void read_words(ExactSums<T>& sum, std::span<const std::int64_t> from)
{
  sum.read(from);
}
template <class T>
void read_words(std::span<ExactSums<T>> sums, std::span<const std::int64_t> from)
{
  for (std::size_t i = 0; i < sums.size(); ++i)
    sums[i].read(from.subspan(i * ExactSums<T>::words, ExactSums<T>::words));
}

/// Bytes to send to a rank or to receive from it.  Sent bytes are not changed.
struct Message {
  int rank;
  std::span<std::byte> bytes;
  bool at_most = false;  ///< of a received message: it may be shorter
};

/// Messages in transit, see Communicator::start.  An object that is reused in every step allocates memory once only.
class PendingMessages {
 public:
  PendingMessages() noexcept;
  PendingMessages(PendingMessages&&) noexcept;
  PendingMessages& operator=(PendingMessages&&) noexcept;
  /// Without wait(), for example after an exception, the destructor waits some seconds for the messages and then cancels them; the run can
  /// then only end, see Ranks::end.
  ~PendingMessages();

  /// Returns when all messages have been received and the sent bytes may be overwritten.  Throws EnvironmentError, also if a message has
  /// another length than expected.  Does nothing if no messages are in transit.
  void wait();

 private:
  friend class Communicator;
  struct Requests;
  std::unique_ptr<Requests> requests_;
};

/// The ranks of a run as seen from one of them.  A default-constructed communicator has one rank, without MPI: every call is then the
/// identity.  Collective calls must be made by every rank, in the same order; all calls are collective except start(), neighbours() and
/// abort().  Only the main thread may call.  Failures of MPI are EnvironmentErrors that name the MPI function.
class Communicator {
 public:
  Communicator() noexcept;
  Communicator(Communicator&&) noexcept;
  Communicator& operator=(Communicator&&) noexcept;
  ~Communicator();

  int rank() const noexcept { return rank_; }
  int size() const noexcept { return size_; }
  bool alone() const noexcept { return size_ == 1; }
  bool is_root() const noexcept { return rank_ == 0; }
  const Traffic& traffic() const noexcept { return traffic_; }

  /// Adds the numbers of all ranks, entry by entry, in place; all ranks receive the result.
  void sum(std::span<std::int64_t> numbers);
  std::int64_t sum(std::int64_t number)
  {
    sum(std::span(&number, 1));
    return number;
  }
  /// Adds the sums of all ranks, in one message; all ranks receive the result.  Arguments are ExactSums, or spans of equal length on all
  /// ranks.
  template <class... Sums>
  requires requires(const Sums&... sums) { (words_in(sums) + ...); }
  void sum(Sums&&... sums) { sum_words(nullptr, sums...); }
  /// As sum() above, for sums that are repeated: sends only the digits in use.
  template <class... Sums>
  void sum(Digits& digits, Sums&&... sums)
  {
    sum_words(&digits, sums...);
  }

  /// The minimum over all ranks, on all ranks.  NaN on one rank gives NaN on all, and -0 is less than 0, so the result does not depend on
  /// the order of ranks.
  Real min(Real number);
  Real max(Real number) { return -min(-number); }
  std::int64_t min(std::int64_t number);
  std::int64_t max(std::int64_t number) { return ~min(~number); }
  /// The minima over all ranks of several numbers and of one integer, in place.
  void least(std::span<Real> numbers, std::int64_t& word);

  /// Copies the bytes of the rank `from`, of any length, to all ranks.
  void broadcast(std::vector<std::byte>& bytes, int from);
  void broadcast(std::string& text, int from);
  /// The text of the lowest rank with a text that is not empty, on all ranks.
  std::string first(std::string text);
  /// The bytes of each rank in the order of ranks, on the root; nothing on other ranks.
  std::vector<std::vector<std::byte>> gather(std::span<const std::byte> bytes);
  /// Sends out[r] to rank r and returns what each rank has sent to this one; both have size() entries.  Meant for set-up, because every
  /// rank sends to every other.
  std::vector<std::vector<std::byte>> all_to_all(const std::vector<std::vector<std::byte>>& out);
  void barrier();

  /// Starts to send and receive messages whose lengths both sides know; an empty message is not sent.  Both sides list the messages between
  /// them in the same order.  The bytes must stay valid until wait().  Messages with different tags, in [0, tags), do not mix, and those of
  /// one tag arrive in the order in which they were sent, so each kind of message can use one tag in all steps.  On one rank alone out[i]
  /// is copied to in[i].
  void start(std::span<const Message> out, std::span<const Message> in, int tag, PendingMessages& pending);
  static constexpr int tags = 1000;

  /// Sends out[i] to ranks[i] and returns the messages from these ranks, in the order of `ranks`, for lengths that the receiver does not
  /// know.  Each of these ranks must list this one as well.  The call has a tag of its own.
  std::vector<std::vector<std::byte>> neighbours(std::span<const int> ranks, const std::vector<std::vector<std::byte>>& out, int tag);

  /// Sets the largest size [bytes] of one MPI message; longer messages are split, because MPI counts bytes in int.  Must be equal on all
  /// ranks; tests make it smaller.
  void cut_messages(std::size_t bytes) noexcept { piece_ = bytes; }

  /// If any rank has an error, every rank throws the error of the lowest such rank: the same message, and the same type if it is one of
  /// core/error.hpp or std::bad_alloc; other types become std::runtime_error on other ranks.
  void agree(const std::exception_ptr& error);
  /// Calls f() on the root only, for work on files; an exception of it is thrown on every rank, as in agree().
  template <class F>
  void together(F&& f)
  {
    agree(is_root() ? caught(f) : nullptr);
  }
  /// Calls f() and returns its exception, for agree(): comm.agree(Communicator::caught([&] { ... })).
  template <class F>
  static std::exception_ptr caught(F&& f) noexcept
  {
    try {
      f();
      return nullptr;
    } catch (...) {
      return std::current_exception();
    }
  }

  /// Ends all ranks at once with this exit code.  Buffered output of C streams is written, nothing else is cleaned up.  A single rank ends
  /// in the same way, by std::_Exit.
  [[noreturn]] void abort(int code) const noexcept;

 private:
  friend class Ranks;
  friend class PendingMessages;
  struct Group;
  explicit Communicator(std::unique_ptr<Group> group) noexcept;
  enum class Reduction { sum, min };
  void reduce(std::span<std::int64_t> numbers, Reduction reduction);
  template <class... Sums>
  void sum_words(Digits* digits, Sums&... sums)
  {
    if (alone())
      return;
    words_.resize((words_in(sums) + ...));
    std::span<std::int64_t> rest = words_;
    const auto next = [&](std::size_t words) {
      const auto here = rest.first(words);
      rest = rest.subspan(words);
      return here;
    };
    (write_words(sums, next(words_in(sums))), ...);
    digits == nullptr ? sum(std::span(words_)) : sum_in_use(*digits);
    rest = words_;
    (read_words(sums, next(words_in(sums))), ...);
  }
  void sum_in_use(Digits& digits);  // words_
  template <class Bytes>
  void spread(Bytes& bytes, int from);
  void count(int tag, int bytes) noexcept;
  void post(std::span<const Message> out, std::span<const Message> in, int tag, PendingMessages& pending);

  std::unique_ptr<Group> group_;  ///< MPI's communicator; may be null on a single rank
  int rank_ = 0, size_ = 1;
  std::size_t piece_ = std::size_t{1} << 30;  ///< largest size of one MPI message [bytes]
  Traffic traffic_;
  std::vector<std::int64_t> words_;
};

/// Bytes viewed as rows of T, a plain struct of numbers.
template <class T>
std::vector<std::vector<T>> rows_of(const std::vector<std::vector<std::byte>>& received)
{
  std::vector<std::vector<T>> rows;
  for (const std::vector<std::byte>& bytes : received) {
    rows.emplace_back(bytes.size() / sizeof(T));
    if (!bytes.empty())
      std::memcpy(static_cast<void*>(rows.back().data()), bytes.data(), bytes.size());
  }
  return rows;
}
/// The rows of each rank in the order of ranks, on the root; nothing on other ranks.  Collective.
template <class T>
std::vector<std::vector<T>> gather_rows(Communicator& ranks, std::span<const T> rows)
{
  return rows_of<T>(ranks.gather(std::as_bytes(rows)));
}

/// Sends out[r] to rank r and returns the rows that each rank has sent to this one.  Collective.
template <class T>
std::vector<std::vector<T>> exchange_rows(Communicator& ranks, const std::vector<std::vector<T>>& out)
{
  std::vector<std::vector<std::byte>> outgoing;
  for (const std::vector<T>& rows : out) {
    const auto bytes = std::as_bytes(std::span(rows));
    outgoing.emplace_back(bytes.begin(), bytes.end());
  }
  return rows_of<T>(ranks.all_to_all(outgoing));
}

/// The numbers of all ranks in the order of ranks, on all ranks.  Collective.
inline std::vector<std::int64_t> of_all_ranks(Communicator& ranks, std::int64_t number)
{
  std::vector<std::int64_t> numbers(static_cast<std::size_t>(ranks.size()), 0);
  numbers[static_cast<std::size_t>(ranks.rank())] = number;
  ranks.sum(numbers);
  return numbers;
}

/// A communicator with this rank only, for work that does not involve the others.
Communicator& one_rank();
/// The communicator of this process: one rank, unless Ranks has found others.
Communicator& world();
/// Leaves work that cannot be parallel to the root: returns true on the root, whose world() has one rank from then on, and false on the
/// others, which must end.  Collective.
bool goes_on_as_root();

/// To be made once, at the beginning of main().  If the process was launched as one of several ranks, world() is their communicator until
/// end().  Throws EnvironmentError if MPI cannot start, or if it finds another number of ranks than the launcher has started.
class Ranks {
 public:
  Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  ~Ranks();

  /// To be called at the end of main(): `return ranks.end(code)`.  With the code 0 it waits for the other ranks without using a core.  With
  /// any other code it gives the other ranks some seconds to end, as they do when all throw the same error; if one does not, the job is
  /// aborted with that code.  Without ranks it returns the code.  `message` is printed to standard error by the root, and by a rank that
  /// ends alone.
  int end(int code, const char* message = nullptr) noexcept;

 private:
  bool running_ = false;
};

}  // namespace talus
