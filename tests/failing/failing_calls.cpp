// LD_PRELOAD: the n-th call of a kind fails, as on a full or broken disk or without memory, or the program is killed there.
//
// FAILING_KIND  malloc, write, fsync, rename, unlink; any of them but malloc: io
// FAILING_AT    number of the call, from 0 on, counted from main() on
// FAILING_ON    set: all later ones fail as well
// FAILING_KILL  set: SIGKILL instead
// FAILING_COUNT file that gets the number of calls when the program has ended by itself
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
}

namespace {

enum Kind { no_kind, of_malloc, of_write, of_fsync, of_rename, of_unlink, of_io };

Kind wanted = no_kind;
long fails_at = -1;
bool fails_on = false, kills = false;
std::atomic<long> calls{0};
std::atomic<bool> in_main{false};

template <class F>
F next(const char* name)
{
  return reinterpret_cast<F>(::dlsym(RTLD_NEXT, name));
}

bool fails(Kind kind)
{
  if (!in_main.load(std::memory_order_relaxed) || (kind != wanted && (wanted != of_io || kind == of_malloc)))
    return false;
  const long number = calls.fetch_add(1);
  const bool now = number == fails_at || (fails_on && fails_at >= 0 && number > fails_at);
  if (now && kills)
    ::raise(SIGKILL);
  return now;
}

int (*true_main)(int, char**, char**) = nullptr;

int counted_main(int argc, char** argv, char** environment)
{
  const char* const kind = std::getenv("FAILING_KIND");
  constexpr const char* names[] = {"", "malloc", "write", "fsync", "rename", "unlink", "io"};
  for (int k = of_malloc; kind != nullptr && k <= of_io; ++k)
    if (std::strcmp(kind, names[k]) == 0)
      wanted = static_cast<Kind>(k);
  if (const char* const at = std::getenv("FAILING_AT"))
    fails_at = std::atol(at);
  fails_on = std::getenv("FAILING_ON") != nullptr;
  kills = std::getenv("FAILING_KILL") != nullptr;
  in_main = true;
  const int code = true_main(argc, argv, environment);
  in_main = false;
  if (const char* const file = std::getenv("FAILING_COUNT"))
    if (std::FILE* const to = std::fopen(file, "w")) {
      std::fprintf(to, "%ld\n", calls.load());
      std::fclose(to);
    }
  return code;
}

bool is_standard(int handle) { return handle >= 0 && handle <= 2; }

}  // namespace

extern "C" {

int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv, void (*begin)(), void (*end)(), void (*end_of_loader)(),
                      void* stack)
{
  true_main = main;
  return next<decltype(&__libc_start_main)>("__libc_start_main")(counted_main, argc, argv, begin, end, end_of_loader, stack);
}

void* malloc(std::size_t bytes)
{
  if (fails(of_malloc))
    return errno = ENOMEM, nullptr;
  return __libc_malloc(bytes);
}
void* calloc(std::size_t number, std::size_t bytes)
{
  if (fails(of_malloc))
    return errno = ENOMEM, nullptr;
  return __libc_calloc(number, bytes);
}
void* realloc(void* old, std::size_t bytes)
{
  if (fails(of_malloc))
    return errno = ENOMEM, nullptr;
  return __libc_realloc(old, bytes);
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes)
{
  if (fails(of_malloc))
    return errno = ENOMEM, nullptr;
  return __libc_memalign(alignment, bytes);
}
int posix_memalign(void** to, std::size_t alignment, std::size_t bytes)
{
  if (fails(of_malloc))
    return ENOMEM;
  *to = __libc_memalign(alignment, bytes);
  return *to == nullptr ? ENOMEM : 0;
}

ssize_t write(int handle, const void* bytes, std::size_t size)
{
  if (!is_standard(handle) && fails(of_write))
    return errno = EIO, -1;
  return next<decltype(&write)>("write")(handle, bytes, size);
}
ssize_t writev(int handle, const struct iovec* parts, int count)
{
  if (!is_standard(handle) && fails(of_write))
    return errno = EIO, -1;
  return next<decltype(&writev)>("writev")(handle, parts, count);
}
ssize_t pwrite(int handle, const void* bytes, std::size_t size, off_t at)
{
  if (fails(of_write))
    return errno = EIO, -1;
  return next<decltype(&pwrite)>("pwrite")(handle, bytes, size, at);
}
ssize_t pwrite64(int handle, const void* bytes, std::size_t size, off64_t at)
{
  if (fails(of_write))
    return errno = EIO, -1;
  return next<decltype(&pwrite64)>("pwrite64")(handle, bytes, size, at);
}
int fflush(std::FILE* file)
{
  if (file != nullptr && file != stdout && file != stderr && fails(of_write))
    return errno = EIO, EOF;
  return next<decltype(&fflush)>("fflush")(file);
}
int fsync(int handle)
{
  if (fails(of_fsync))
    return errno = EIO, -1;
  return next<decltype(&fsync)>("fsync")(handle);
}
int rename(const char* from, const char* to)
{
  if (fails(of_rename))
    return errno = EIO, -1;
  return next<decltype(&rename)>("rename")(from, to);
}
int unlink(const char* file)
{
  if (fails(of_unlink))
    return errno = EIO, -1;
  return next<decltype(&unlink)>("unlink")(file);
}
int remove(const char* file)
{
  if (fails(of_unlink))
    return errno = EIO, -1;
  return next<decltype(&remove)>("remove")(file);
}

}  // extern "C"
