// isolated.cpp — runs the library in a child process, which may crash, hang or ask for too much.
#include "base/error.hpp"
#include "formats/openvdb/load.hpp"
#include "par/pages.hpp"
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace molmesh::formats {
namespace {

/// What the child sends before the values, or before a message of `message` bytes.
struct Head {
  uint32_t message;
  int32_t status;
  bool level_set;
  uint32_t name;
  Vec3i points;
  Vec3d origin, axis[3];
};

bool send(int to, const void* from, size_t n) {
  const char* p = static_cast<const char*>(from);
  while (n > 0) {
    const ssize_t sent = write(to, p, n);
    if (sent < 0 && errno == EINTR)
      continue;
    if (sent <= 0)
      return false;
    p += sent;
    n -= static_cast<size_t>(sent);
  }
  return true;
}
bool receive(int from, void* to, size_t n) {
  char* p = static_cast<char*>(to);
  while (n > 0) {
    const ssize_t got = read(from, p, n);
    if (got < 0 && errno == EINTR)
      continue;
    if (got <= 0)
      return false;
    p += got;
    n -= static_cast<size_t>(got);
  }
  return true;
}

void limit(int resource, rlim_t most) {
  rlimit now{};
  getrlimit(static_cast<__rlimit_resource>(resource), &now);
  now.rlim_cur = std::min(now.rlim_cur, most);
  setrlimit(static_cast<__rlimit_resource>(resource), &now);
}

/// Never returns. What the parent watches and will remove is none of the child's.
[[noreturn]] void child(int to, std::string_view bytes, const std::string& name, const std::string& file) {
  for (const int s : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTERM, SIGINT, SIGHUP, SIGXCPU})
    signal(s, SIG_DFL);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, 5 + 2 * bytes.size() / 1'000'000); // seconds
  limit(RLIMIT_AS, (rlim_t{4} << 30) + 256 * rlim_t{bytes.size()});
  Head head{};
  std::string message;
  ForeignGrid grid;
  try {
    grid = load_openvdb(bytes, name, file);
    head.level_set = grid.level_set;
    head.points = grid.map.points;
    head.origin = grid.map.origin;
    std::copy_n(grid.map.axis, 3, head.axis);
  } catch (const Error& e) {
    message = e.what();
    head.status = static_cast<int32_t>(e.status);
  } catch (const std::exception& e) { // out of memory
    message = file + ": V1: " + e.what() + ", expected a whole OpenVDB file";
    head.status = static_cast<int32_t>(Status::bad_input);
  }
  head.message = static_cast<uint32_t>(message.size());
  head.name = static_cast<uint32_t>(grid.name.size());
  const bool sent = send(to, &head, sizeof head) && send(to, message.data(), message.size()) &&
                    send(to, grid.name.data(), grid.name.size()) &&
                    send(to, grid.map.value.data(), 4 * grid.map.value.size());
  _exit(sent ? 0 : 1);
}

} // namespace

bool has_openvdb() {
#ifdef MOLMESH_OPENVDB
  return true;
#else
  return false;
#endif
}

ForeignGrid read_openvdb(std::string_view bytes, const std::string& name, const std::string& file) {
  if (!has_openvdb())
    return load_openvdb(bytes, name, file); // which says so
  int ends[2];
  if (pipe(ends) != 0)
    fail(Status::failed, file + ": " + std::strerror(errno));
  const pid_t pid = fork();
  if (pid < 0)
    fail(Status::failed, file + ": " + std::strerror(errno));
  if (pid == 0) {
    close(ends[0]);
    child(ends[1], bytes, name, file);
  }
  close(ends[1]);
  Head head{};
  std::string message;
  ForeignGrid grid;
  bool whole = receive(ends[0], &head, sizeof head);
  if (whole && head.message > 0) {
    message.resize(std::min<uint32_t>(head.message, 4096));
    whole = receive(ends[0], message.data(), message.size());
  } else if (whole) {
    grid.level_set = head.level_set;
    grid.map.points = head.points;
    grid.map.origin = head.origin;
    std::copy_n(head.axis, 3, grid.map.axis);
    grid.name.resize(head.name);
    par::resize_pages(grid.map.value, static_cast<size_t>(int64_t{head.points.x} * head.points.y * head.points.z),
                      1);
    whole = receive(ends[0], grid.name.data(), grid.name.size()) &&
            receive(ends[0], grid.map.value.data(), 4 * grid.map.value.size());
  }
  close(ends[0]);
  int state = 0;
  while (waitpid(pid, &state, 0) < 0 && errno == EINTR) {
  }
  if (!message.empty())
    fail(static_cast<Status>(head.status), message);
  if (!whole)
    fail_input(file + ": V1: the OpenVDB library ended on it, expected a whole OpenVDB file");
  return grid;
}

} // namespace molmesh::formats
