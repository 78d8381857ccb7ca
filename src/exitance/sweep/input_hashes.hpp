#pragma once

#include <map>
#include <string>
#include <vector>

#include "exitance/base/result.hpp"

namespace exitance {

/// Files next to `path` to which its text refers, directly or through other files: material files, textures,
/// photometric files. Relative paths are searched in the folder of the referring file. `path` itself is the first
/// entry. Binary files name nothing. Error: cannot_read.
Result<std::vector<std::string>> files_named_by(const std::string& path);

/// A file that a command reads.
struct HashedFile {
    std::string path, hash;
};

/// Hashes of the files that commands read. Each file is read once in the lifetime of this object.
class InputHashes {
  public:
    /// Hash of the content of a file and of all files that it names; empty if `path` is not a plain file. Error:
    /// cannot_read.
    Result<std::string> of(const std::string& path);
    /// All files that a word of a command names, relative to the folder `base`: the whole word, or parts of
    /// it between '=', ',', ';' and blanks. Empty if it names none.
    Result<std::vector<HashedFile>> of_word(const std::string& word, const std::string& base);

  private:
    std::map<std::string, std::string> known_;
};

}  // namespace exitance
