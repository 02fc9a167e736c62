#pragma once
// The ranks of a run, and all that passes between them: the only code that talks to MPI.  What comes out is the same bits for any number of
// ranks as long as sums are exact ones or of integers.
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

/// Whether a launcher (mpirun, srun with PMI or PMIx) has started this process as one of several, to go by the environment.
bool launched_as_ranks();

/// Takes what says so out of the environment, for programs that this process starts: they are no ranks of its job.
void forget_launch() noexcept;

/// How many ranks the launcher has started on this machine, by the environment; 1 where it does not say.
int ranks_on_this_machine();

/// What this rank has sent so far.
struct Traffic {
  std::int64_t messages = 0, bytes = 0;      ///< to single ranks
  std::int64_t calls = 0, bytes_to_all = 0;  ///< sums, minima and broadcasts, and what it gave into them
  std::int64_t bytes_gathered = 0;           ///< for gather() and all_to_all(), at set-up and for files
};

/// Which digits of sums are in use that are asked for again and again: most of an ExactSum's are not, and need not be sent.  The same on all
/// ranks, and never fewer than before.
class Digits {
  friend class Communicator;
  struct Range {
    std::int64_t lowest, behind;  ///< words of an ExactSum; none are if the second is not the larger
  };
  std::vector<Range> of_sum_;
  std::vector<std::int64_t> packed_;
};

/// ExactSums, and spans of them, as words.
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

/// Bytes for or from a rank.  What is sent is not changed.
struct Message {
  int rank;
  std::span<std::byte> bytes;
  bool at_most = false;  ///< to be received: less may come
};

/// Messages on their way, see Exchange::start.  Kept from step to step it allocates once only.
class PendingMessages {
 public:
  PendingMessages() noexcept;
  PendingMessages(PendingMessages&&) noexcept;
  PendingMessages& operator=(PendingMessages&&) noexcept;
  /// Without wait(), as on the way of an exception, it gives the messages some seconds; what has not come then is called off, and the run
  /// can only end: see Ranks::end.
  ~PendingMessages();

  /// Returns when all has been received and what was sent may be overwritten.  Throws EnvironmentError, also where a message has another
  /// length than its parcel.  Nothing to wait for is nothing done.
  void wait();

 private:
  friend class Communicator;
  struct Requests;
  std::unique_ptr<Requests> requests_;
};

/// The ranks of a run as one of them sees them.  Made by default it is one rank alone, for which every call is the identity and MPI
/// does not exist.
///
/// Collectives are those calls that every rank has to make, in the same order: all but start() and neighbours(), which concern the ranks
/// they name, and abort().  They are for the main thread.  Where MPI fails they throw EnvironmentError, which names MPI's own function.
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

  /// In place, on all ranks: sums entry by entry.
  void sum(std::span<std::int64_t> numbers);
  std::int64_t sum(std::int64_t number)
  {
    sum(std::span(&number, 1));
    return number;
  }
  /// Every rank's sums become those of all ranks, in one message for all of them: ExactSums, or spans of as many as every rank has.
  template <class... Sums>
  requires requires(const Sums&... sums) { (words_in(sums) + ...); }
  void sum(Sums&&... sums) { sum_words(nullptr, sums...); }
  /// The same for sums that are asked for again and again.
  template <class... Sums>
  void sum(Digits& digits, Sums&&... sums)
  {
    sum_words(&digits, sums...);
  }

  /// Of all ranks, on all ranks.  NaN on one of them is NaN on all, and -0 is less than 0: the bits do not depend on the order.
  Real min(Real number);
  Real max(Real number) { return -min(-number); }
  std::int64_t min(std::int64_t number);
  std::int64_t max(std::int64_t number) { return ~min(~number); }
  /// The same for several at once, in place; and of a word.
  void least(std::span<Real> numbers, std::int64_t& word);

  /// What the rank `from` has, of whatever length, to all.
  void broadcast(std::vector<std::byte>& bytes, int from);
  void broadcast(std::string& text, int from);
  /// The text of the lowest rank that has one, on all ranks.
  std::string first(std::string text);
  /// On the root what each rank has given, rank by rank; elsewhere nothing.
  std::vector<std::vector<std::byte>> gather(std::span<const std::byte> bytes);
  /// Gives out[r] to rank r and returns what each rank has given to this one, both of size().  For set-up: every rank asks every other.
  std::vector<std::vector<std::byte>> all_to_all(const std::vector<std::vector<std::byte>>& out);
  void barrier();

  /// Posts messages of lengths that both sides know; an empty parcel is no message at all.  Both sides list the parcels between them in the
  /// same order.  The bytes must stay until talk.wait().  Messages of different tags, in [0, tags), do not mix, and those of one tag arrive
  /// in the order they were sent, so that the messages of one kind of every step may have the same.  A rank alone copies out[i] to in[i].
  void start(std::span<const Message> out, std::span<const Message> in, int tag, PendingMessages& talk);
  static constexpr int tags = 1000;

  /// Sends out[i] to ranks[i] and returns what these ranks have sent here, in the order of `ranks`: for lengths that the receiver does not
  /// know.  Concerns those ranks only, each of which has to list this one as well.  A tag of its own, as above.
  std::vector<std::vector<std::byte>> neighbours(std::span<const int> ranks, const std::vector<std::vector<std::byte>>& out, int tag);

  /// A longer message goes in pieces of so many bytes, as MPI counts them in int.  The same on all ranks; smaller in tests only.
  void cut_messages(std::size_t bytes) noexcept { piece_ = bytes; }

  /// If any rank has an error, every rank throws that of the lowest: the same message, and of the same type if it is of core/error.hpp or
  /// std::bad_alloc; any other is std::runtime_error on the other ranks.
  void agree(const std::exception_ptr& error);
  /// f() on the root alone, for files; what it throws is thrown on every rank, as in agree().
  template <class F>
  void together(F&& f)
  {
    agree(is_root() ? caught(f) : nullptr);
  }
  /// What f() throws, for agree(): exchange.agree(Exchange::caught([&] { ... })).
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

  /// Ends all ranks at once with this exit code, wherever they are.  What C streams hold is written, nothing else is cleaned up.  Of a
  /// rank that is alone it ends the process in the same way, by std::_Exit.
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
  void post(std::span<const Message> out, std::span<const Message> in, int tag, PendingMessages& talk);

  std::unique_ptr<Group> group_;  ///< MPI's; of a rank alone there may be none
  int rank_ = 0, size_ = 1;
  std::size_t piece_ = std::size_t{1} << 30;  ///< [bytes]
  Traffic traffic_;
  std::vector<std::int64_t> words_;
};

/// Bytes as rows of T, which is numbers in a row.
template <class T>
std::vector<std::vector<T>> rows_of(const std::vector<std::vector<std::byte>>& letters)
{
  std::vector<std::vector<T>> rows;
  for (const std::vector<std::byte>& bytes : letters) {
    rows.emplace_back(bytes.size() / sizeof(T));
    if (!bytes.empty())
      std::memcpy(static_cast<void*>(rows.back().data()), bytes.data(), bytes.size());
  }
  return rows;
}
/// On the root the rows of each rank, rank by rank; elsewhere nothing.  Every rank has to ask.
template <class T>
std::vector<std::vector<T>> gather_rows(Communicator& ranks, std::span<const T> rows)
{
  return rows_of<T>(ranks.gather(std::as_bytes(rows)));
}

/// Gives out[r] to rank r and returns what each rank has given.  The same.
template <class T>
std::vector<std::vector<T>> exchange_rows(Communicator& ranks, const std::vector<std::vector<T>>& out)
{
  std::vector<std::vector<std::byte>> letters;
  for (const std::vector<T>& rows : out) {
    const auto bytes = std::as_bytes(std::span(rows));
    letters.emplace_back(bytes.begin(), bytes.end());
  }
  return rows_of<T>(ranks.all_to_all(letters));
}

/// The number of each rank, on all ranks.  The same.
inline std::vector<std::int64_t> of_all_ranks(Communicator& ranks, std::int64_t number)
{
  std::vector<std::int64_t> numbers(static_cast<std::size_t>(ranks.size()), 0);
  numbers[static_cast<std::size_t>(ranks.rank())] = number;
  ranks.sum(numbers);
  return numbers;
}

/// For whoever is alone, however many ranks there are.
Communicator& one_rank();
/// The exchange of this process: one rank alone, unless Ranks has found others.
Communicator& world();
/// For what ranks do not share: true on the root, which is alone in the world from here on, false on the others, for which nothing is left but
/// to end.  Every rank has to call it.
bool goes_on_as_root();

/// Made once, first thing in main(): if the process was launched as one of several ranks world() becomes theirs until end().  Throws
/// EnvironmentError if MPI cannot start, or finds another number of ranks than the launcher has started.
class Ranks {
 public:
  Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  ~Ranks();

  /// Last thing in main(), when all has been printed: `return ranks.end(code)`.  A code of 0 waits for the other ranks, however long, and keeps
  /// no core busy meanwhile.  With any other code they have some seconds to end as well, as they do when all throw alike; one that does not,
  /// because it waits for this rank, would wait for ever, so then the job is aborted with that code.  Without ranks it returns the code, that
  /// is all.
  /// `message` goes to standard error: of the root, and of a rank that ends by itself.
  int end(int code, const char* message = nullptr) noexcept;

 private:
  bool running_ = false;
};

}  // namespace talus
