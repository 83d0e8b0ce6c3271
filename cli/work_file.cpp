// work_file.cpp — O_TMPFILE and linkat, or a random name made exclusively; written, synced, renamed.
#include "cli/work_file.hpp"
#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

namespace molmesh::cli {
namespace {

constexpr size_t buffer_size = 1 << 16;
constexpr int most_attempts = 100; // of 2^96 names

/// The folder of a path with its last slash, "" for the one that is worked in.
std::string folder_of(const std::string& path) {
  return path.substr(0, path.rfind('/') + 1);
}

std::string random_name(const std::string& folder) {
  uint32_t word[3];
  if (getrandom(word, sizeof word, 0) != sizeof word)
    return {};
  char text[40];
  std::snprintf(text, sizeof text, ".molmesh-%08x%08x%08x", word[0], word[1], word[2]);
  return folder + text;
}

std::string open_name(int fd) {
  return "/proc/self/fd/" + std::to_string(fd);
}

} // namespace

WorkFile::WorkFile(const std::string& target, Name name) : target_(target), folder_(folder_of(target)) {
  struct stat old {};
  const bool replaces = stat(target.c_str(), &old) == 0;
  if (!replaces && !note(errno == ENOENT)) // a name that is too long, a folder that is none
    return;
  if (name == Name::none_if_possible) {
    fd_ = open(folder_.empty() ? "." : folder_.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
    if (fd_ >= 0 && access(open_name(fd_).c_str(), F_OK) != 0) { // no /proc: it could never be named
      close(fd_);
      fd_ = -1;
    }
  }
  if (fd_ < 0 && !make_named())
    return;
  if (replaces && !note(fchmod(fd_, old.st_mode & 07777) == 0))
    return;
  buffer_.resize(buffer_size);
  setp(buffer_.data(), buffer_.data() + buffer_.size());
}

WorkFile::~WorkFile() {
  if (fd_ >= 0)
    close(fd_);
}

bool WorkFile::note(bool good) {
  if (!good && error == 0)
    error = errno != 0 ? errno : EIO;
  return good;
}

template <class Make>
bool WorkFile::take_random_name(Make&& make) {
  for (int attempt = 0; attempt < most_attempts; ++attempt) {
    name_ = random_name(folder_);
    if (name_.empty())
      break;
    temporary_ = std::make_unique<Temporary>(name_); // before the file: a signal may come between
    if (make(name_.c_str()))
      return true;
    temporary_->keep(); // it is another's
    temporary_ = nullptr;
    if (errno != EEXIST)
      break;
  }
  return note(false);
}

bool WorkFile::make_named() {
  return take_random_name([&](const char* name) {
    fd_ = open(name, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    return fd_ >= 0;
  });
}

bool WorkFile::write_out(const char* from, std::streamsize n) {
  while (error == 0 && n > 0) {
    const ssize_t done = write(fd_, from, static_cast<size_t>(std::min<std::streamsize>(n, 1 << 30)));
    if (done < 0 && errno == EINTR)
      continue;
    if (!note(done > 0))
      break;
    from += done;
    n -= done;
  }
  return error == 0;
}

WorkFile::int_type WorkFile::overflow(int_type c) {
  if (sync() != 0)
    return traits_type::eof();
  if (!traits_type::eq_int_type(c, traits_type::eof())) {
    *pptr() = traits_type::to_char_type(c);
    pbump(1);
  }
  return traits_type::not_eof(c);
}

std::streamsize WorkFile::xsputn(const char* from, std::streamsize n) {
  if (n <= epptr() - pptr()) {
    std::copy_n(from, n, pptr());
    pbump(static_cast<int>(n));
    return n;
  }
  return sync() == 0 && write_out(from, n) ? n : 0;
}

int WorkFile::sync() {
  const bool good = fd_ >= 0 && write_out(pbase(), pptr() - pbase());
  if (!buffer_.empty())
    setp(buffer_.data(), buffer_.data() + buffer_.size());
  return good ? 0 : -1;
}

bool WorkFile::complete() {
  errno = 0;
  return sync() == 0 && note(fsync(fd_) == 0);
}

bool WorkFile::link_named() {
  return take_random_name([&](const char* name) {
    return linkat(AT_FDCWD, open_name(fd_).c_str(), AT_FDCWD, name, AT_SYMLINK_FOLLOW) == 0;
  });
}

bool WorkFile::publish() {
  errno = 0;
  if (!temporary_) {
    // A link takes no other file's place: where there is one, a name of its own and a rename.
    if (linkat(AT_FDCWD, open_name(fd_).c_str(), AT_FDCWD, target_.c_str(), AT_SYMLINK_FOLLOW) == 0)
      return true;
    if (!note(errno == EEXIST) || !link_named())
      return false;
  }
  if (!note(std::rename(name_.c_str(), target_.c_str()) == 0))
    return false;
  temporary_->keep();
  return true;
}

} // namespace molmesh::cli
