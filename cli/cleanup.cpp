// cleanup.cpp — a fixed table of paths, since a signal handler may neither allocate nor lock.
#include "cli/cleanup.hpp"
#include "base/error.hpp"
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
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

// What ends a process: people, batch systems and their limits, timers, std::terminate.
constexpr int deadly[] = {SIGHUP,  SIGINT,  SIGQUIT, SIGTERM,   SIGUSR1, SIGUSR2,
                          SIGXCPU, SIGALRM, SIGPROF, SIGVTALRM, SIGABRT};

void unlink_watched() {
  for (const Slot& slot : table)
    if (slot.watched)
      unlink(slot.path);
}

// A second signal waits until all are gone, or finds another thread, which removes them all itself before it ends
// the process.
void die_clean(int signal) {
  unlink_watched();
  std::signal(signal, SIG_DFL); // delivered when this returns: the caller sees which signal it was
  raise(signal);
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
  struct sigaction action {};
  action.sa_handler = die_clean;
  for (int signal : deadly)
    sigaddset(&action.sa_mask, signal);
  for (int signal : deadly) {
    struct sigaction before {};
    sigaction(signal, nullptr, &before);
    if (before.sa_handler != SIG_IGN)
      sigaction(signal, &action, nullptr); // nohup stays in force
  }
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
