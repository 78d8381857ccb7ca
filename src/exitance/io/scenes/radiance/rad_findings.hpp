#pragma once

#include <map>
#include <string>
#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Position in Radiance files.
struct RadPlace {
    const std::string& file;
    int line = 0;
};

/// Collects findings of the Radiance reader: all errors and warnings, and one note per kind of omitted part.
class RadFindings {
  public:
    void error(const RadPlace& at, std::string message, std::string hint = "");
    void warning(const RadPlace& at, std::string message);
    /// Notes that `what` is omitted.
    void note(const std::string& what, const RadPlace& at);

    bool failed() const { return errors_.size() > 0; }
    std::size_t error_count() const { return errors_.size(); }
    /// Returns all findings and clears the list.
    std::vector<Finding> take();

  private:
    struct Note {
        std::string file;
        int line = 0;
        std::size_t count = 0;
    };
    std::vector<Finding> errors_, warnings_;
    std::map<std::string, Note> notes_;
};

}  // namespace exitance
