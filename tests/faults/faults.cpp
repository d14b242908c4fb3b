// A library to be loaded before a program (LD_PRELOAD): one of its calls that change files fails, or the program is
// killed there. Only calls on files in one directory count: open, write, pwrite, fsync, fdatasync, fchmod,
// ftruncate, rename, mkdir, unlink.
//
//   ROPEWALK_FAULTS_BELOW  the directory, absolute
//   ROPEWALK_FAULT         HOW:N[:on]   at the Nth call, from 1; "on": from then on. HOW: kill (before the call),
//                          torn (in the middle of a write; nothing at other calls), term (SIGTERM, and the call
//                          goes on), ENOSPC, EIO, EDQUOT, EINTR, EROFS,
//                          EINVAL, EPERM
//   ROPEWALK_FAULTS_NO_LOCKS   set: no file system has locks
//   ROPEWALK_FAULTS_COUNT  file that takes the number of calls at the end
//   ROPEWALK_FAULTS_MADE   file that is there once a fault was made, in whichever process: each counts from the
//                          number of its parent on
//   ROPEWALK_FAULTS_TOGETHER   file that holds one count for all processes
//   ROPEWALK_FAULTS_CALL   the name of the only call that counts
//
// With HOW = memory the calls are those of operator new, and the directory does not matter. The Nth fails until the
// program's new_handler has given something up; "on": and from then on all large ones fail.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>
#include <string_view>

namespace {

// Texts of the environment: a string would ask for memory, and that asks for the fault.
struct Fault {
  std::string_view how, below;
  long at = 0;
  bool on = false;

  Fault() {
    if (const char* text = std::getenv("ROPEWALK_FAULTS_BELOW")) below = text;
    const char* text = std::getenv("ROPEWALK_FAULT");
    if (!text) return;
    const std::string_view all = text;
    const std::size_t colon = all.find(':');
    how = all.substr(0, colon);
    at = std::atol(text + colon + 1);
    on = all.size() > 3 && all.compare(all.size() - 3, 3, ":on") == 0;
  }
};

const Fault& fault() {
  static const Fault f;
  return f;
}

template <class F>
F real(const char* name) {
  return reinterpret_cast<F>(dlsym(RTLD_NEXT, name));
}

// The number of calls so far.
std::atomic<long>& calls() {
  static std::atomic<long> own{0};
  static std::atomic<long>* const counted = [] {
    const char* path = std::getenv("ROPEWALK_FAULTS_TOGETHER");
    const int fd =
        path ? real<int (*)(const char*, int, ...)>("open")(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666) : -1;
    if (fd < 0 || real<int (*)(int, off_t)>("ftruncate")(fd, sizeof(long)) != 0) return &own;
    void* shared = mmap(nullptr, sizeof(long), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    close(fd);
    return shared == MAP_FAILED ? &own : static_cast<std::atomic<long>*>(shared);
  }();
  return *counted;
}

bool is_below(const char* path) {
  if (fault().below.empty() || fault().how == "memory" || !path) return false;
  std::string absolute = path;
  if (path[0] != '/') {
    char here[PATH_MAX];
    if (!getcwd(here, sizeof here)) return false;
    absolute = std::string(here) + "/" + path;
  }
  const std::string_view below = fault().below;
  return absolute.compare(0, below.size(), below) == 0;
}

bool is_below(int fd) {
  char name[64], path[PATH_MAX];
  std::snprintf(name, sizeof name, "/proc/self/fd/%d", fd);
  const ssize_t n = readlink(name, path, sizeof path - 1);
  if (n <= 0) return false;
  path[n] = '\0';
  return is_below(path);
}

int code_of(std::string_view how) {
  if (how == "ENOSPC") return ENOSPC;
  if (how == "EDQUOT") return EDQUOT;
  if (how == "EINTR") return EINTR;
  if (how == "EROFS") return EROFS;
  if (how == "EINVAL") return EINVAL;
  if (how == "EPERM") return EPERM;
  return EIO;
}

void note_the_fault() {
  static const auto call = real<int (*)(const char*, int, ...)>("open");
  const char* path = std::getenv("ROPEWALK_FAULTS_MADE");
  const int fd = path ? call(path, O_WRONLY | O_CREAT | O_CLOEXEC, 0666) : -1;
  if (fd >= 0) close(fd);
}

// The number of the call is counted here. True: it is to fail, with errno.
bool fails(const char* name, bool counts, bool* torn = nullptr) {
  static const char* const only = std::getenv("ROPEWALK_FAULTS_CALL");
  if (!counts || fault().how == "memory" || (only && std::strcmp(only, name) != 0)) return false;
  const long k = ++calls();
  const Fault& f = fault();
  if (f.at == 0 || !(k == f.at || (f.on && k > f.at))) return false;
  note_the_fault();
  if (f.how == "torn") {
    if (torn) *torn = true;
    return false;
  }
  if (f.how == "term") {
    raise(SIGTERM);
    return false;
  }
  if (f.how == "kill") raise(SIGKILL);
  errno = code_of(f.how);
  return true;
}

constexpr std::size_t large = 4096;  // bytes

// As operator new of the library; without memory where the fault asks for it.
void* allocated(std::size_t size, std::size_t alignment) {
  static thread_local bool here = false;  // what this library itself asks for does not count
  if (!here) {
    here = true;
    const Fault& f = fault();
    const long k = f.how == "memory" ? ++calls() : 0;
    here = false;
    const bool for_good = f.on && size > large;
    if (k > 0 && f.at > 0 && (k == f.at || (for_good && k > f.at))) do {
        if (!std::get_new_handler()) throw std::bad_alloc();
        std::get_new_handler()();  // throws where there is nothing left to give up
      } while (for_good);
  }
  void* memory = alignment > 0 ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                               : std::malloc(size > 0 ? size : 1);
  if (!memory) throw std::bad_alloc();
  return memory;
}

struct AtEnd {
  ~AtEnd() {
    const char* path = std::getenv("ROPEWALK_FAULTS_COUNT");
    if (std::FILE* file = path ? std::fopen(path, "w") : nullptr) {
      std::fprintf(file, "%ld\n", calls().load());
      std::fclose(file);
    }
  }
} at_end;

constexpr int writing = O_WRONLY | O_RDWR | O_CREAT;

}  // namespace

void* operator new(std::size_t size) { return allocated(size, 0); }
void* operator new[](std::size_t size) { return allocated(size, 0); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocated(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return allocated(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

extern "C" {

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  static const auto call = real<int (*)(const char*, int, ...)>("open");
  return fails("open", (flags & writing) && is_below(path)) ? -1 : call(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  static const auto call = real<int (*)(const char*, int, ...)>("open64");
  return fails("open64", (flags & writing) && is_below(path)) ? -1 : call(path, flags, mode);
}

ssize_t write(int fd, const void* data, size_t size) {
  static const auto call = real<ssize_t (*)(int, const void*, size_t)>("write");
  bool torn = false;
  if (fails("write", is_below(fd), &torn)) return -1;
  if (!torn) return call(fd, data, size);
  if (call(fd, data, size / 2) >= 0) raise(SIGKILL);
  return -1;
}

ssize_t pwrite(int fd, const void* data, size_t size, off_t at) {
  static const auto call = real<ssize_t (*)(int, const void*, size_t, off_t)>("pwrite");
  bool torn = false;
  if (fails("pwrite", is_below(fd), &torn)) return -1;
  if (!torn) return call(fd, data, size, at);
  if (call(fd, data, size / 2, at) >= 0) raise(SIGKILL);
  return -1;
}

int fsync(int fd) {
  static const auto call = real<int (*)(int)>("fsync");
  return fails("fsync", is_below(fd)) ? -1 : call(fd);
}

int fdatasync(int fd) {
  static const auto call = real<int (*)(int)>("fdatasync");
  return fails("fdatasync", is_below(fd)) ? -1 : call(fd);
}

int fchmod(int fd, mode_t mode) {
  static const auto call = real<int (*)(int, mode_t)>("fchmod");
  return fails("fchmod", is_below(fd)) ? -1 : call(fd, mode);
}

int ftruncate(int fd, off_t size) {
  static const auto call = real<int (*)(int, off_t)>("ftruncate");
  return fails("ftruncate", is_below(fd)) ? -1 : call(fd, size);
}

int rename(const char* from, const char* to) {
  static const auto call = real<int (*)(const char*, const char*)>("rename");
  return fails("rename", is_below(to)) ? -1 : call(from, to);
}

int mkdir(const char* path, mode_t mode) {  // which no signal interrupts
  static const auto call = real<int (*)(const char*, mode_t)>("mkdir");
  return fails("mkdir", fault().how != "EINTR" && is_below(path)) ? -1 : call(path, mode);
}

int flock(int fd, int operation) {
  static const auto call = real<int (*)(int, int)>("flock");
  static const bool none = std::getenv("ROPEWALK_FAULTS_NO_LOCKS");
  if (!none) return call(fd, operation);
  errno = ENOLCK;
  return -1;
}

int unlink(const char* path) {
  static const auto call = real<int (*)(const char*)>("unlink");
  return fails("unlink", is_below(path)) ? -1 : call(path);
}

}  // extern "C"
