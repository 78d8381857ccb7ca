#pragma once

#include <map>
#include <string>
#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Where something stands in Radiance's files.
struct RadPlace {
    const std::string& file;
    int line = 0;
};

/// Findings of the reader of Radiance's files: errors and warnings one by one, parts that are left out once per kind.
class RadFindings {
  public:
    void error(const RadPlace& at, std::string message, std::string hint = "");
    void warning(const RadPlace& at, std::string message);
    /// `what` is left out.
    void note(const std::string& what, const RadPlace& at);

    bool failed() const { return errors_.size() > 0; }
    std::size_t error_count() const { return errors_.size(); }
    /// Hands all of it over.
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
