#pragma once

#include <string>
#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Numbers the lines of several files consecutively, so that one number identifies file and line.
class SceneLines {
  public:
    /// Adds a file with `lines` lines. Returns the offset to add to its own line numbers.
    int add(const std::string& file, int lines);
    /// Adds the files of `more`. Returns the offset to add to its numbers.
    int append(const SceneLines& more);
    bool empty() const { return files_.empty(); }

    /// Replaces the number in a finding, and in its message, by the file and its own line number.
    void place(Finding& finding) const;

  private:
    struct File {
        std::string name;
        int before, lines;
    };
    const File* find(int line) const;
    std::vector<File> files_;
};

}  // namespace exitance
