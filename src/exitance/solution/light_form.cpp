#include "exitance/solution/light_form.hpp"

#include <algorithm>
#include <vector>

#include "exitance/base/check.hpp"

namespace exitance {
namespace {

std::vector<LightFormKind>& kinds() {
    static std::vector<LightFormKind> known;
    return known;
}

auto find_kind(std::string_view name) {
    return std::find_if(kinds().begin(), kinds().end(), [&](const LightFormKind& k) { return k.name == name; });
}

}  // namespace

QuadraticTriangle LightForm::triangle(const Scene&, std::size_t, const Spectrum&) const {
    return {};
}

void add_light_form(const LightFormKind& kind) {
    if (find_kind(kind.name) == kinds().end()) kinds().push_back(kind);
}

LightFormPointer unpack_light_form(std::string_view name, std::string_view bytes) {
    if (name.empty()) return {};
    const auto kind = find_kind(name);
    EXI_CHECK(kind != kinds().end());
    return kind->unpack(bytes);
}

}  // namespace exitance
