#include "exitance/scene/findings.hpp"

#include <algorithm>

namespace exitance {
namespace {
bool is_error(const Finding& f) {
    return f.kind == Finding::Kind::error;
}
}  // namespace

void sort_findings(std::vector<Finding>& findings) {
    std::stable_sort(findings.begin(), findings.end(), [](const Finding& a, const Finding& b) {
        if (is_error(a) != is_error(b)) return is_error(a);
        return a.file != b.file ? a.file < b.file : a.line < b.line;
    });
}

bool has_errors(std::span<const Finding> findings) {
    return std::any_of(findings.begin(), findings.end(), is_error);
}

Error error_of(std::span<const Finding> findings) {
    const auto first = std::find_if(findings.begin(), findings.end(), is_error);
    EXI_CHECK(first != findings.end());
    const auto more = std::count_if(first + 1, findings.end(), is_error);
    std::string message = first->message;
    if (more > 0) message += " (and " + std::to_string(more) + (more == 1 ? " more error)" : " more errors)");
    return {ErrorCode::bad_input, message, place_of(*first), first->hint};
}

std::string place_of(const Finding& f) {
    return f.line > 0 ? f.file + ":" + std::to_string(f.line) : f.file;
}

}  // namespace exitance
