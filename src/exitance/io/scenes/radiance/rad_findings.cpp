#include "exitance/io/scenes/radiance/rad_findings.hpp"

#include <fmt/format.h>

#include <iterator>

namespace exitance {

void RadFindings::error(const RadPlace& at, std::string message, std::string hint) {
    errors_.push_back({Finding::Kind::error, at.file, at.line, std::move(message), std::move(hint)});
}

void RadFindings::warning(const RadPlace& at, std::string message) {
    warnings_.push_back({Finding::Kind::warning, at.file, at.line, std::move(message), ""});
}

void RadFindings::note(const std::string& what, const RadPlace& at) {
    ++notes_.try_emplace(what, Note{at.file, at.line, 0}).first->second.count;
}

std::vector<Finding> RadFindings::take() {
    std::vector<Finding> out = std::move(errors_);
    errors_.clear();
    std::move(warnings_.begin(), warnings_.end(), std::back_inserter(out));
    warnings_.clear();
    for (const auto& [what, note] : notes_)
        out.push_back(
            {Finding::Kind::warning, note.file, note.line,
             fmt::format("left out: {}{}", what,
                         note.count == 1 ? "" : fmt::format(" ({} times, the first of them here)", note.count)),
             ""});
    notes_.clear();
    return out;
}

}  // namespace exitance
