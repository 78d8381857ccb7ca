#include "exitance/io/scenes/radiance/rad_shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/io/files/text_lines.hpp"

namespace exitance {
namespace {

/// Converts the numbers of a primitive. Each function makes a shape or reports an error.
class ShapeReader {
  public:
    ShapeReader(const RadPrimitive& p, const std::string& file, RadFindings& findings)
        : p_(p), v_(p.numbers), file_(file), findings_(findings) {}

    std::optional<RadShape> polygon() {
        if (v_.size() < 9 || v_.size() % 3 != 0) return wrong(fmt::format("has {} numbers", v_.size()));
        RadShape out;
        out.facets.emplace_back();
        for (std::size_t i = 0; i < v_.size(); i += 3) out.facets[0].push_back(point(i));
        return out;
    }

    std::optional<RadShape> sphere() {
        if (v_.size() != 4) return wrong_count(4);
        if (v_[3] == 0) return wrong("has radius 0");
        return RadShape{sphere_facets(point(0), std::abs(v_[3])), (p_.type == "bubble") != (v_[3] < 0), true};
    }

    std::optional<RadShape> ring() {
        if (v_.size() != 8) return wrong_count(8);
        const double length = norm(point(3)), inner = std::min(v_[6], v_[7]), outer = std::max(v_[6], v_[7]);
        if (!(length > 0) || inner < 0 || !(outer > inner)) return wrong("has no direction or no width");
        return RadShape{ring_facets(point(0), point(3) / length, inner, outer)};
    }

    std::optional<RadShape> cone() {
        const bool two_radii = p_.type == "cone" || p_.type == "cup";
        if (v_.size() != (two_radii ? 8u : 7u)) return wrong_count(two_radii ? 8 : 7);
        const double from = v_[6], to = two_radii ? v_[7] : v_[6];
        if (point(0) == point(3) || from < 0 || to < 0 || from + to == 0) return wrong("has no length or no radius");
        return RadShape{cone_facets(point(0), point(3), from, to), p_.type == "cup" || p_.type == "tube"};
    }

  private:
    Point point(std::size_t i) const { return {v_[i], v_[i + 1], v_[i + 2]}; }
    std::optional<RadShape> wrong(const std::string& why) {
        findings_.error({file_, p_.line}, fmt::format("{} '{}' {}", p_.type, shown(p_.name), why));
        return std::nullopt;
    }
    std::optional<RadShape> wrong_count(std::size_t count) {
        return wrong(fmt::format("has {} numbers, not {}", v_.size(), count));
    }

    const RadPrimitive& p_;
    const std::vector<double>& v_;
    const std::string& file_;
    RadFindings& findings_;
};

}  // namespace

bool is_rad_shape(const std::string& type) {
    static constexpr std::array shapes = {"polygon", "sphere", "bubble", "ring", "cone", "cup", "cylinder", "tube"};
    return std::find(shapes.begin(), shapes.end(), type) != shapes.end();
}

std::optional<RadShape> rad_shape(const RadPrimitive& p, const std::string& file, RadFindings& findings) {
    ShapeReader reader(p, file, findings);
    if (p.type == "polygon") return reader.polygon();
    if (p.type == "sphere" || p.type == "bubble") return reader.sphere();
    return p.type == "ring" ? reader.ring() : reader.cone();
}

}  // namespace exitance
