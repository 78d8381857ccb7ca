#include "exitance/cli/view/view_changes.hpp"

#include "exitance/what_if/light_groups/light_change_words.hpp"

namespace exitance {
namespace {

/// Calls read(word) for every word of a list separated by commas, until one fails.
template <class Read>
Result<void> for_words(const std::string& text, const Read& read) {
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        if (const Result<void> done = read(std::string_view(text).substr(begin, end - begin)); !done) return done;
        begin = end + 1;
    }
    return {};
}

}  // namespace

Result<LightChange> read_light_change(const ViewServer::Parameters& parameters) {
    LightChange change;
    const Result<void> dimmed =
        for_words(view_text(parameters, "dim"), [&](std::string_view word) { return read_dim(word, change, ':'); });
    if (!dimmed) return dimmed.error();
    const Result<void> painted = for_words(view_text(parameters, "paint"), [&](std::string_view word) {
        return read_reflectance(word, change, ':', '/');
    });
    if (!painted) return painted.error();
    return change;
}

}  // namespace exitance
