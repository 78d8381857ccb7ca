#pragma once

#include <string>
#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// The lines of several files counted on from one to the next, so that one number says file and line.
class SceneLines {
  public:
    /// Adds a file of so many lines; returns what is to be added to its own line numbers.
    int add(const std::string& file, int lines);
    /// Adds the files of another book; returns what is to be added to its numbers.
    int append(const SceneLines& more);
    bool empty() const { return files_.empty(); }

    /// Puts file and line of its own into a finding that has a number of this book, in its message too.
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
