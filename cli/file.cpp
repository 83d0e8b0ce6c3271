// file.cpp — which file a path means, and whether what was written is there.
#include "cli/file.hpp"
#include "base/error.hpp"
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <iostream>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace molmesh::cli {
namespace fs = std::filesystem;

bool same_file(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty() || a == "-" || b == "-")
    return false;
  std::error_code none;
  const auto device = [&](const std::string& path) {
    const fs::file_status status = fs::status(path, none);
    return fs::exists(status) && !fs::is_regular_file(status);
  };
  if (device(a) || device(b))
    return false;
  if (fs::equivalent(a, b, none))
    return true;
  const fs::path x = fs::weakly_canonical(fs::absolute(a, none), none),
                 y = fs::weakly_canonical(fs::absolute(b, none), none);
  return !x.empty() && x == y;
}

int standard_stream(const std::string& path) {
  if (path == "-")
    return STDOUT_FILENO;
  struct stat file {
  }, stream{};
  if (stat(path.c_str(), &file) == 0 && S_ISREG(file.st_mode))
    for (const int fd : {STDOUT_FILENO, STDERR_FILENO})
      if (fstat(fd, &stream) == 0 && stream.st_dev == file.st_dev && stream.st_ino == file.st_ino)
        return fd;
  return -1;
}

std::streamsize HeadKeepingBuffer::take(char* to, std::streamsize n) {
  const std::streamsize taken = from_->sgetn(to, n);
  ended = ended || taken < n;
  if (head.size() < most)
    head.append(to, std::min(most - head.size(), static_cast<std::size_t>(taken)));
  return taken;
}

HeadKeepingBuffer::int_type HeadKeepingBuffer::underflow() {
  const std::streamsize n = take(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  if (n <= 0)
    return traits_type::eof();
  setg(buffer_.data(), buffer_.data(), buffer_.data() + n);
  return traits_type::to_int_type(buffer_[0]);
}

std::streamsize HeadKeepingBuffer::xsgetn(char* to, std::streamsize n) {
  const std::streamsize kept = std::min(n, static_cast<std::streamsize>(egptr() - gptr()));
  std::copy_n(gptr(), kept, to);
  setg(eback(), gptr() + kept, egptr());
  return kept + (kept < n ? take(to + kept, n - kept) : 0);
}

namespace {

HeadKeepingBuffer& standard_input() {
  static HeadKeepingBuffer buffer(std::cin.rdbuf());
  return buffer;
}

} // namespace

const std::string& head_of_standard_input() {
  return standard_input().head;
}

bool standard_input_was_empty() {
  return standard_input().ended && standard_input().head.empty();
}

InputFile::InputFile(const std::string& path) : name_(path) {
  if (path == "-") {
    static bool asked_for = false;
    if (std::exchange(asked_for, true))
      fail(Status::usage, "standard input is asked for twice, expected at most once");
    standard_ = true;
    name_ = "<stdin>";
    struct stat file {};
    if (fstat(STDIN_FILENO, &file) == 0 && S_ISDIR(file.st_mode))
      fail_input(name_ + ": is a directory, expected a file");
    if (isatty(STDIN_FILENO))
      std::cerr << terminal_note << std::flush;
    return;
  }
  std::error_code ignored;
  if (fs::is_directory(path, ignored))
    fail_input(path + ": is a directory, expected a file");
  errno = 0;
  file_.open(path, std::ios::binary);
  if (!file_)
    fail_input(path + ": cannot open: " + std::strerror(errno ? errno : ENOENT));
}

std::istream& InputFile::stream() {
  static std::istream standard(&standard_input());
  return standard_ ? standard : file_;
}

void NotingBuffer::note(bool failed) {
  if (failed && error == 0)
    error = errno;
}

NotingBuffer::int_type NotingBuffer::overflow(int_type c) {
  if (traits_type::eq_int_type(c, traits_type::eof()))
    return traits_type::not_eof(c);
  const int_type done = to_->sputc(traits_type::to_char_type(c));
  note(traits_type::eq_int_type(done, traits_type::eof()));
  return done;
}

std::streamsize NotingBuffer::xsputn(const char* from, std::streamsize n) {
  const std::streamsize done = to_->sputn(from, n);
  note(done < n);
  return done;
}

int NotingBuffer::sync() {
  const int done = to_->pubsync();
  note(done < 0);
  return done;
}

namespace {

bool is_terminal(const std::string& path) {
  const int file = open(path.c_str(), O_WRONLY | O_NOCTTY | O_NONBLOCK);
  const bool found = file >= 0 && isatty(file);
  if (file >= 0)
    close(file);
  return found;
}

/// Through symbolic links, also to what is not there yet.
std::string followed(fs::path path) {
  std::error_code none;
  constexpr int most = 40; // as the system has it
  for (int n = 0; n < most && fs::is_symlink(fs::symlink_status(path, none)); ++n)
    path = path.parent_path() / fs::read_symlink(path, none);
  return path.string();
}

[[noreturn]] void refuse_terminal() {
  fail(Status::usage, "--output: found a terminal, expected a file, as by -o FILE, or a pipe");
}

} // namespace

OutputFile::OutputFile(const std::string& path, Content content)
    : path_(path), standard_(standard_stream(path)), noting_(standard_ == STDOUT_FILENO   ? std::cout.rdbuf()
                                                             : standard_ == STDERR_FILENO ? std::cerr.rdbuf()
                                                                                          : &device_),
      stream_(&noting_) {
  if (standard_ >= 0) {
    const int flags = fcntl(standard_, F_GETFL);
    if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY) { // closed by the caller
      errno = EBADF;
      refuse("cannot write");
    }
    if (content == Content::binary && isatty(standard_))
      refuse_terminal();
    return;
  }
  std::error_code none;
  const fs::file_status status = fs::status(path, none);
  if (content == Content::binary && fs::is_character_file(status) && is_terminal(path))
    refuse_terminal();
  errno = 0;
  if (!fs::exists(status) || fs::is_regular_file(status)) {
    work_ = std::make_unique<WorkFile>(followed(path));
    stream_.rdbuf(work_.get());
    if (work_->error != 0)
      refuse("cannot open");
  } else if (!device_.open(path, std::ios::binary | std::ios::out | std::ios::trunc))
    refuse("cannot open");
}

namespace {

[[noreturn]] void refuse_output(const std::string& path, const char* what, int error) {
  fail(Status::not_written,
       (path == "-" ? "<stdout>" : path) + ": " + what + ": " + std::strerror(error ? error : EIO));
}

} // namespace

void OutputFile::refuse(const char* what) const {
  const int noted = work_ ? work_->error : noting_.error;
  refuse_output(path_, what, noted ? noted : errno);
}

CompleteFile OutputFile::complete() {
  errno = 0;
  stream_.flush();
  if (!stream_ || (work_ && !work_->complete()) || (standard_ < 0 && !work_ && !device_.close()))
    refuse("cannot write");
  stream_.rdbuf(nullptr);
  return {path_, std::move(work_)};
}

void CompleteFile::publish() {
  if (file && !file->publish())
    refuse_output(path, "cannot rename", file->error);
}

} // namespace molmesh::cli
