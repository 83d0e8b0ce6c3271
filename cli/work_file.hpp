// work_file.hpp — the file that is written before an output gets its name.
#pragma once
#include "cli/cleanup.hpp"
#include <memory>
#include <streambuf>
#include <string>
#include <vector>

namespace molmesh::cli {

/// A new file in the folder of `target`. Where the file system and /proc allow it the file has no name until
/// publish(), so that nothing of a process that ends is left; else it has a random name, made exclusively and
/// watched by Temporary. Nobody can foresee the name: neither a link nor a pipe that lies in the folder is ever
/// followed. Where there is a `target` its permissions are kept.
class WorkFile : public std::streambuf {
public:
  enum class Name { none_if_possible, random };
  /// `error` of a file that could not be made says why.
  explicit WorkFile(const std::string& target, Name name = Name::none_if_possible);
  ~WorkFile() override;
  WorkFile(const WorkFile&) = delete;
  WorkFile& operator=(const WorkFile&) = delete;
  int error = 0; ///< errno of the first failure, 0: none
  /// Writes what is buffered and brings it to the disk. False: see error.
  bool complete();
  /// Gives the file the name `target` at one stroke; what had it is gone. False: see error.
  bool publish();

protected:
  int_type overflow(int_type c) override;
  std::streamsize xsputn(const char* from, std::streamsize n) override;
  int sync() override;

private:
  template <class Make> ///< make(name): whether it could be made
  bool take_random_name(Make&& make);
  bool make_named();
  bool link_named();
  bool write_out(const char* from, std::streamsize n);
  bool note(bool good);
  std::string target_, folder_, name_;
  std::unique_ptr<Temporary> temporary_;
  int fd_ = -1;
  std::vector<char> buffer_;
};

} // namespace molmesh::cli
