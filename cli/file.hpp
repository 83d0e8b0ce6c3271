// file.hpp — inputs that may be stdin, outputs that are whole or absent (I10).
#pragma once
#include "cli/work_file.hpp"
#include <array>
#include <fstream>
#include <iosfwd>
#include <memory>
#include <streambuf>
#include <string>

namespace molmesh::cli {

/// Do two paths name one regular file, one that exists or one to be written? Standard streams and devices do not.
bool same_file(const std::string& a, const std::string& b);

/// Descriptor of the standard stream, output or error, that a path means: "-" or the regular file it was redirected
/// to, by that file's name or as /dev/stdout. -1: neither.
int standard_stream(const std::string& path);

/// Passes standard input on and keeps its first bytes, for messages: nobody can read a pipe again.
class HeadKeepingBuffer : public std::streambuf {
public:
  explicit HeadKeepingBuffer(std::streambuf* from) : from_(from) {}
  static constexpr std::size_t most = 4096;
  std::string head;
  bool ended = false; ///< there was nothing more to read

protected:
  int_type underflow() override;
  std::streamsize xsgetn(char* to, std::streamsize n) override;

private:
  std::streamsize take(char* to, std::streamsize n);
  std::streambuf* from_;
  std::array<char, 1 << 14> buffer_{};
};

/// The first bytes of standard input, as far as they have been read.
const std::string& head_of_standard_input();

/// It was read, and held nothing: the program before in a pipe has stopped.
bool standard_input_was_empty();

/// What standard error gets before a terminal is read, where people may wait for an answer; empty: nothing.
inline std::string terminal_note;

/// "-" is standard input. Throws Error(bad_input) when the file cannot be opened or is a directory.
class InputFile {
public:
  explicit InputFile(const std::string& path);
  std::istream& stream();
  /// For messages: the path, or "<stdin>".
  const std::string& name() const { return name_; }

private:
  std::string name_;
  std::ifstream file_;
  bool standard_ = false;
};

/// Passes everything on and keeps errno of the first failure: streams forget it long before anybody asks.
class NotingBuffer : public std::streambuf {
public:
  explicit NotingBuffer(std::streambuf* to) : to_(to) {}
  int error = 0; ///< 0: no failure

protected:
  int_type overflow(int_type c) override;
  std::streamsize xsputn(const char* from, std::streamsize n) override;
  int sync() override;

private:
  void note(bool failed);
  std::streambuf* to_;
};

/// All of it is on the disk, and it waits for its name.
struct CompleteFile {
  std::string path;               ///< for messages
  std::unique_ptr<WorkFile> file; ///< null: there is nothing to name
  /// Throws Error(not_written).
  void publish();
};

/// "-" is standard output, and so is the regular file it was redirected to. A regular file is written beside its
/// place and gets its name when it is complete (work_file.hpp); until then, or when a signal ends the process,
/// nothing is left behind and an older file of that name stays as it was. A symbolic link is followed; a device or
/// named pipe is written directly. Throws Error(not_written), and Error(usage) for binary content on a terminal.
class OutputFile {
public:
  enum class Content { text, binary }; ///< binary: not to a terminal; pages, too, which nobody reads there
  explicit OutputFile(const std::string& path, Content content = Content::text);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  std::ostream& stream() { return stream_; }
  /// Flush, check, sync.
  CompleteFile complete();
  /// And give it its name.
  void commit() { complete().publish(); }

private:
  [[noreturn]] void refuse(const char* what) const;
  std::string path_;
  int standard_;                   ///< as standard_stream(path)
  std::unique_ptr<WorkFile> work_; ///< a regular file's
  std::filebuf device_;
  NotingBuffer noting_; ///< of standard streams and devices
  std::ostream stream_;
};

} // namespace molmesh::cli
