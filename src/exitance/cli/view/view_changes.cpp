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

/// Reads the changes of light that a request specifies. Error (usage): malformed words.
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

}  // namespace

Result<std::shared_ptr<const Viewed>> ViewChanges::find(const Viewed& base, const ViewServer::Parameters& parameters) {
    const std::string words = view_text(parameters, "dim") + "\n" + view_text(parameters, "paint");
    const std::lock_guard lock(mutex_);
    for (const auto& [of, viewed] : kept_)
        if (of == words) return viewed;
    const Result<LightChange> change = read_light_change(parameters);
    if (!change) return change.error();
    Solution solution = base.solution;
    std::vector<double> factors;
    for (const LightGroup& group : groups_.groups) factors.push_back(group.factor);
    const Result<void> changed = change_light(solution, groups_, *change);
    for (std::size_t g = 0; g < factors.size(); ++g) groups_.groups[g].factor = factors[g];
    if (!changed) return changed.error();
    auto viewed = std::make_shared<const Viewed>(std::move(solution), base.camera);
    kept_.emplace_back(words, viewed);
    if (kept_.size() > max_kept) kept_.erase(kept_.begin());
    return std::shared_ptr<const Viewed>(viewed);
}

}  // namespace exitance
