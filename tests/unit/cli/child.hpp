// child.hpp — runs a piece of a tool in a process of its own, as a shell would.
#pragma once
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace molmesh::test {

/// An empty folder that goes away with the object.
struct Folder {
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "molmesh.XXXXXX").string();
    if (!mkdtemp(name.data()))
      throw std::runtime_error("mkdtemp");
    path = name;
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string operator/(const std::string& name) const { return (path / name).string(); }
  size_t files() const { return static_cast<size_t>(std::distance(std::filesystem::directory_iterator(path), {})); }
  std::filesystem::path path;
};

inline std::string contents(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

struct Outcome {
  int status = -1, signal = 0;
  std::string out, err;
};

/// body() in a child; its standard streams are files of a folder apart. `before` runs first, with the streams in
/// place.
inline Outcome in_child(
    const std::function<int()>& body, const std::function<void()>& before = [] {}) {
  const Folder folder;
  const std::string out = folder / "out", err = folder / "err";
  const auto redirect = [](const std::string& file, int fd) {
    const int opened = open(file.c_str(), O_WRONLY | O_CREAT, 0600);
    dup2(opened, fd);
    close(opened);
  };
  std::cout.flush();
  std::cerr.flush();
  const pid_t child = fork();
  if (child == 0) {
    redirect(out, STDOUT_FILENO);
    redirect(err, STDERR_FILENO);
    before();
    const int status = body();
    std::cout.flush();
    std::fflush(nullptr);
    _exit(status);
  }
  int wait_status = 0;
  waitpid(child, &wait_status, 0);
  Outcome o;
  if (WIFEXITED(wait_status))
    o.status = WEXITSTATUS(wait_status);
  if (WIFSIGNALED(wait_status))
    o.signal = WTERMSIG(wait_status);
  o.out = contents(out);
  o.err = contents(err);
  return o;
}

} // namespace molmesh::test
