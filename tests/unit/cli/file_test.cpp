// file_test.cpp — an output is whole or absent, whatever happens to the process (I10).
#include "base/error.hpp"
#include "child.hpp"
#include "cli/file.hpp"
#include "unit/refusal.hpp"
#include <catch2/catch.hpp>
#include <csignal>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

using namespace molmesh;
using namespace molmesh::test;

namespace {

/// Status and message of writing `bytes` zeros to `path` and committing.
std::pair<Status, std::string> attempt(const std::string& path, size_t bytes) {
  try {
    cli::OutputFile file(path);
    file.stream() << std::string(bytes, '\0');
    file.commit();
    return {Status::good, ""};
  } catch (const Error& e) {
    return {e.status, e.what()};
  }
}
Status write(const std::string& path, size_t bytes) {
  return attempt(path, bytes).first;
}

} // namespace

TEST_CASE("a committed output has its name, its contents and no company") {
  const Folder folder;
  {
    cli::OutputFile file(folder / "a");
    file.stream() << "seven tetrahedra";
    CHECK_FALSE(std::filesystem::exists(folder / "a"));
    CHECK(folder.files() == 1);
    file.commit();
  }
  CHECK(contents(folder / "a") == "seven tetrahedra");
  CHECK(folder.files() == 1);
}

TEST_CASE("an output that is not committed leaves the older file alone") {
  const Folder folder;
  std::ofstream(folder / "a") << "old";
  { cli::OutputFile(folder / "a").stream() << "new, unfinished"; }
  CHECK(contents(folder / "a") == "old");
  CHECK(folder.files() == 1);
}

TEST_CASE("an output that cannot be opened or written is status 4") {
  const Folder folder;
  CHECK(write(folder / "absent/a", 1) == Status::not_written);
  CHECK(write(folder.path.string(), 1) == Status::not_written);
  CHECK(write("/dev/full", 1) == Status::not_written);
  CHECK(write("/dev/full", 1 << 20) == Status::not_written);
  CHECK(write("/dev/null", 1 << 20) == Status::good);
  CHECK(folder.files() == 0);
}

TEST_CASE("the message says why, also when writing failed long before the end") {
  for (const size_t bytes : {size_t{1}, size_t{1} << 20})
    CHECK(attempt("/dev/full", bytes).second == "/dev/full: cannot write: No space left on device");
  const Outcome o = in_child([] {
    dup2(open("/dev/full", O_WRONLY), STDOUT_FILENO);
    return static_cast<int>(attempt("-", 1 << 20).second != "<stdout>: cannot write: No space left on device");
  });
  CHECK(o.status == 0);
}

TEST_CASE("a disk that fills up is status 4 and leaves nothing") {
  const Folder folder;
  const Outcome o = in_child([&] {
    cli::guard_process();
    const rlimit limit{1 << 16, 1 << 16}; // bytes a file may have: stands in for the disk
    setrlimit(RLIMIT_FSIZE, &limit);
    return static_cast<int>(write(folder / "a", 1 << 20));
  });
  CHECK(o.status == 4);
  CHECK(folder.files() == 0);
}

TEST_CASE("an output through a symbolic link reaches the file behind it") {
  const Folder folder;
  std::ofstream(folder / "real") << "old";
  std::filesystem::create_symlink("real", folder / "link");
  CHECK(write(folder / "link", 3) == Status::good);
  CHECK(std::filesystem::is_symlink(folder / "link"));
  CHECK(contents(folder / "real") == std::string(3, '\0'));
}

TEST_CASE("a signal removes the temporary file and still ends the process") {
  for (int signal :
       {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGUSR1, SIGUSR2, SIGXCPU, SIGALRM, SIGPROF, SIGVTALRM, SIGABRT}) {
    const Folder folder;
    const Outcome o = in_child([&] {
      const rlimit no_core{0, 0};
      setrlimit(RLIMIT_CORE, &no_core);
      cli::guard_process();
      cli::OutputFile file(folder / "a"), report(folder / "b");
      file.stream() << "unfinished" << std::flush;
      raise(signal);
      return 0;
    });
    CHECK(o.signal == signal);
    CHECK(folder.files() == 0);
  }
}

TEST_CASE("a library that ends the process leaves no temporary file") {
  const Folder folder;
  const Outcome o = in_child([&] {
    cli::guard_process();
    cli::OutputFile file(folder / "a");
    std::exit(1);
    return 0;
  });
  CHECK(o.status == 1);
  CHECK(folder.files() == 0);
}

TEST_CASE("a second signal waits until the temporary files are gone") {
  const Outcome o = in_child([] {
    cli::guard_process();
    struct sigaction action {};
    sigaction(SIGINT, nullptr, &action);
    for (int signal : {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGUSR1, SIGUSR2})
      if (!sigismember(&action.sa_mask, signal))
        return 1;
    return (action.sa_flags & (SA_RESETHAND | SA_NODEFER)) != 0 ? 2 : 0;
  });
  CHECK(o.status == 0);
}

TEST_CASE("a pipe is written directly, also behind a link") {
  const Folder folder;
  const Outcome o = in_child([&] { return static_cast<int>(write("/dev/stdout", 3)); },
                             [&] {
                               int ends[2];
                               if (pipe(ends) != 0 || dup2(ends[1], STDOUT_FILENO) < 0)
                                 _exit(99);
                             });
  CHECK(o.status == 0);
}

TEST_CASE("files are the same however they are spelled, also before they exist") {
  const Folder folder;
  std::filesystem::create_directory(folder / "sub");
  std::ofstream(folder / "real") << "x";
  std::filesystem::create_symlink("real", folder / "link");
  CHECK(cli::same_file(folder / "real", folder / "sub/../link"));
  CHECK(cli::same_file(folder / "absent", folder / "./sub/../absent"));
  CHECK(cli::same_file("absent", "./absent"));
  CHECK(cli::same_file("absent", std::filesystem::absolute("absent").string()));
  CHECK_FALSE(cli::same_file(folder / "absent", folder / "real"));
  CHECK_FALSE(cli::same_file("-", "-"));
  CHECK_FALSE(cli::same_file("/dev/null", "/dev/null"));
}

TEST_CASE("nohup stays in force") {
  const Outcome o = in_child([] {
    std::signal(SIGHUP, SIG_IGN);
    cli::guard_process();
    raise(SIGHUP);
    return 0;
  });
  CHECK(o.status == 0);
}

TEST_CASE("a closed standard output is never replaced by a file opened later") {
  const Folder folder;
  const Outcome o = in_child(
      [&] {
        cli::guard_process();
        cli::OutputFile file(folder / "a");
        file.stream() << "mesh";
        std::cout << "stray" << std::flush;
        std::cerr << "stray" << std::flush;
        file.commit();
        return std::cout ? 0 : 4;
      },
      [] {
        close(STDOUT_FILENO);
        close(STDERR_FILENO);
      });
  CHECK(o.status == 4);
  CHECK(contents(folder / "a") == "mesh");
}

TEST_CASE("an input that is absent or a folder is status 3 and named") {
  const Folder folder;
  for (const std::string& path : {folder / "absent", folder.path.string()}) {
    CHECK(test::refusal(Status::bad_input, [&] { cli::InputFile file(path); }).rfind(path + ": ", 0) == 0);
  }
  CHECK(cli::InputFile("-").name() == "<stdin>");
}
