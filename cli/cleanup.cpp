// cleanup.cpp — a fixed table of paths, since a signal handler may neither allocate nor lock.
#include "cli/cleanup.hpp"
#include "base/error.hpp"
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <iterator>
#include <unistd.h>

namespace molmesh::cli {
namespace {

constexpr int slots = 16;
constexpr size_t path_size = 4096;
struct Slot {
  std::atomic<bool> taken{false}, watched{false};
  char path[path_size];
};
Slot table[slots];
static_assert(std::atomic<bool>::is_always_lock_free);

// Faults of the program itself: the handler has a stack of its own, since the fault may be that there is none left.
constexpr int faults[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL};
// Those that end no process by default, or are errors of a write here.
constexpr int harmless[] = {SIGCHLD, SIGCONT, SIGSTOP, SIGTSTP,  SIGTTIN, SIGTTOU,
                            SIGURG,  SIGKILL, SIGPIPE, SIGWINCH, SIGXFSZ};
alignas(16) char fault_stack[1 << 16];

void unlink_watched() {
  for (const Slot& slot : table)
    if (slot.watched)
      unlink(slot.path);
}

// A second signal waits until all are gone, or finds another thread, which removes them all itself before it ends
// the process.
void die_clean(int signal) {
  unlink_watched();
  if (getpid() == 1) // the system ignores default actions of a container's first process
    _exit(128 + signal);
  std::signal(signal, SIG_DFL); // delivered when this returns: the caller sees which signal it was
  raise(signal);
}

bool is_in(const int* begin, const int* end, int signal) {
  return std::find(begin, end, signal) != end;
}

/// nohup stays in force, and so do a sanitizer's reports of faults.
void watch(int signal, const struct sigaction& action) {
  struct sigaction before {};
  if (sigaction(signal, nullptr, &before) != 0) // the C library keeps some for itself
    return;
  const bool is_default = (before.sa_flags & SA_SIGINFO) == 0 && before.sa_handler == SIG_DFL;
  const bool ignored = (before.sa_flags & SA_SIGINFO) == 0 && before.sa_handler == SIG_IGN;
  if (is_in(std::begin(faults), std::end(faults), signal) ? is_default : !ignored)
    sigaction(signal, &action, nullptr);
}

} // namespace

void guard_process() {
  // A closed standard input or output becomes one that fails, a closed standard error one that swallows.
  for (int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(fd, F_GETFD) != -1)
      continue;
    const int opened = open("/dev/null", fd == STDOUT_FILENO ? O_RDONLY : O_WRONLY);
    if (opened != fd)
      close(opened);
  }
  std::atexit(unlink_watched); // libgomp ends the process so when it gets no threads
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  stack_t stack{};
  stack.ss_sp = fault_stack;
  stack.ss_size = sizeof fault_stack;
  sigaltstack(&stack, nullptr);
  struct sigaction action {};
  action.sa_handler = die_clean;
  action.sa_flags = SA_ONSTACK;
  sigfillset(&action.sa_mask);
  for (const int fault : faults) // one in the handler ends the process at once
    sigdelset(&action.sa_mask, fault);
  for (int signal = 1; signal <= SIGRTMAX; ++signal)
    if (!is_in(std::begin(harmless), std::end(harmless), signal))
      watch(signal, action);
}

Temporary::Temporary(const std::string& path) : slot_(0) {
  if (path.size() >= path_size)
    fail(Status::not_written, path + ": the path is too long");
  while (slot_ < slots && table[slot_].taken.exchange(true))
    ++slot_;
  if (slot_ == slots)
    fail(Status::not_written, path + ": too many files open for writing");
  std::memcpy(table[slot_].path, path.c_str(), path.size() + 1);
  table[slot_].watched = true;
}

Temporary::~Temporary() {
  if (table[slot_].watched.exchange(false))
    unlink(table[slot_].path);
  table[slot_].taken = false;
}

void Temporary::keep() {
  table[slot_].watched = false;
}

} // namespace molmesh::cli
