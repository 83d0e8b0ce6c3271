// file_test.cpp — an output is whole or absent, whatever happens to the process (I10).
#include "base/error.hpp"
#include "child.hpp"
#include "cli/file.hpp"
#include "unit/refusal.hpp"
#include <catch2/catch.hpp>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <sched.h>
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

namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool reports_faults = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
constexpr bool reports_faults = true;
#else
constexpr bool reports_faults = false;
#endif
#else
constexpr bool reports_faults = false;
#endif

/// A file of a name and one without, unfinished when the signal comes.
int die_of(int signal, const Folder& folder) {
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  if (!reports_faults) // the test's own handlers
    for (const int fault : {SIGSEGV, SIGBUS, SIGFPE, SIGILL})
      std::signal(fault, SIG_DFL);
  cli::guard_process();
  cli::WorkFile named(folder / "a", cli::WorkFile::Name::random), other(folder / "b");
  std::ostream(&named) << "unfinished" << std::flush;
  if (folder.files() == 0 || raise(signal) != 0)
    return 1;
  return 0;
}

} // namespace

TEST_CASE("a signal removes the temporary file and still ends the process") {
  std::vector<int> signals = {SIGHUP,  SIGINT,    SIGQUIT, SIGTERM, SIGUSR1, SIGUSR2, SIGXCPU, SIGALRM,
                              SIGPROF, SIGVTALRM, SIGABRT, SIGIO,   SIGPWR,  SIGTRAP, SIGSYS,  SIGSTKFLT};
  for (int signal = SIGRTMIN; signal <= SIGRTMAX; ++signal)
    signals.push_back(signal);
  if (!reports_faults) // a sanitizer's own handlers end the process first
    signals.insert(signals.end(), {SIGSEGV, SIGBUS, SIGFPE, SIGILL});
  for (const int signal : signals) {
    const Folder folder;
    const Outcome o = in_child([&] { return die_of(signal, folder); });
    INFO(strsignal(signal));
    CHECK(o.signal == signal);
    CHECK(folder.files() == 0);
  }
}

TEST_CASE("the first process of a container ends on a signal, and nothing is left") {
  constexpr int not_allowed = 77;
  for (const int signal : {SIGTERM, SIGINT, SIGSEGV}) {
    if (signal == SIGSEGV && reports_faults)
      continue;
    const Folder folder;
    const Outcome o = in_child([&] {
      if (unshare(CLONE_NEWPID) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWPID) != 0)
        return not_allowed;
      const pid_t first = fork();
      if (first < 0)
        return not_allowed;
      if (first == 0)
        _exit(die_of(signal, folder));
      int status = 0;
      waitpid(first, &status, 0);
      return WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status);
    });
    if (o.status == not_allowed) {
      WARN("skipped: no namespace of processes can be made here");
      return;
    }
    CHECK(o.status == 128 + signal);
    CHECK(folder.files() == 0);
  }
}

TEST_CASE("a file is made under no name or a random one, and gets its own at the end") {
  for (const auto kind : {cli::WorkFile::Name::none_if_possible, cli::WorkFile::Name::random}) {
    const Folder folder;
    for (const char* text : {"first", "second"}) { // the second takes the first's place
      cli::WorkFile file(folder / "a", kind);
      REQUIRE(file.error == 0);
      std::ostream(&file) << text;
      CHECK(folder.files() <= 2);
      REQUIRE(file.complete());
      CHECK((text == std::string("second")) == std::filesystem::exists(folder / "a"));
      REQUIRE(file.publish());
      CHECK(contents(folder / "a") == text);
      CHECK(folder.files() == 1);
    }
    { cli::WorkFile never(folder / "a", kind); }
    CHECK(folder.files() == 1);
  }
}

TEST_CASE("a file that is replaced keeps its permissions and a new one has the caller's") {
  const auto permissions = [](const std::string& file) {
    struct stat status {};
    stat(file.c_str(), &status);
    return status.st_mode & 07777;
  };
  const mode_t before = umask(027);
  const Folder folder;
  CHECK(write(folder / "new", 1) == Status::good);
  CHECK(permissions(folder / "new") == 0640);
  for (const mode_t mode : {0600, 0644, 0664, 0444}) {
    chmod((folder / "new").c_str(), mode);
    CHECK(write(folder / "new", 2) == Status::good);
    CHECK(permissions(folder / "new") == mode);
  }
  umask(before);
}

TEST_CASE("what lies under a foreseeable name is left alone") {
  const Folder folder;
  std::ofstream(folder / "victim") << "precious";
  const std::string name = (folder / "a") + ".tmp." + std::to_string(getpid());
  SECTION("a link") {
    std::filesystem::create_symlink("victim", name);
  }
  SECTION("a pipe") {
    REQUIRE(mkfifo(name.c_str(), 0600) == 0);
  }
  CHECK(write(folder / "a", 3) == Status::good);
  CHECK(contents(folder / "victim") == "precious");
  CHECK(folder.files() == 3);
}

TEST_CASE("names as long as the file system has them are written, longer ones refused before the work") {
  const Folder folder;
  for (const auto kind : {cli::WorkFile::Name::none_if_possible, cli::WorkFile::Name::random}) {
    cli::WorkFile longest(folder / std::string(255, 'a'), kind);
    REQUIRE(longest.error == 0);
    CHECK(longest.complete());
    CHECK(longest.publish());
    CHECK(cli::WorkFile(folder / std::string(256, 'a'), kind).error == ENAMETOOLONG);
  }
  CHECK(folder.files() == 1);
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
