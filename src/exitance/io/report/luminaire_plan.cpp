#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "exitance/io/report/isolux_plan.hpp"
#include "exitance/io/report/report_figures.hpp"

namespace exitance {
namespace {

constexpr double layout_width = 640;  ///< Length of the longer side, in SVG units.

/// Maps points of a room to its layout plan: x to the right, y upwards, as seen from above.
struct LayoutFrame {
    Point low;  ///< Lower left corner of the plan, metres.
    double width = 0, height = 0, to_plan = 1;

    Vec2 at(const Point& p) const { return {to_plan * (p.x - low.x), to_plan * (height - (p.y - low.y))}; }
    bool may_show(const Box& box) const {
        return box.hi.x >= low.x && box.lo.x <= low.x + width && box.hi.y >= low.y && box.lo.y <= low.y + height;
    }
};

LayoutFrame frame_of(const FloorRoom& room) {
    constexpr double border = 0.25;  // metres around the room's rectangle; derived from the thickness of walls
    const MeasuringPlane& r = room.rectangle;
    Box box;
    for (const Point& p : {r.origin, r.origin + r.u, r.origin + r.v, r.origin + r.u + r.v}) box.add(p);
    LayoutFrame out;
    out.low = box.lo - Vec3{border, border, 0};
    out.width = box.size().x + 2 * border, out.height = box.size().y + 2 * border;
    out.to_plan = layout_width / std::max(out.width, out.height);
    return out;
}

/// Path of the lines in which a horizontal plane cuts the surfaces.
std::string cut_at(const Scene& scene, const LayoutFrame& frame, double z) {
    std::string path;
    for (const SurfaceId s : scene.surfaces().ids()) {
        Box box;
        for (const Point& p : scene.outline(s)) box.add(p);
        if (box.lo.z > z || box.hi.z < z || !frame.may_show(box)) continue;
        for (const auto& [a, b] : section_of(scene.outline(s), {0, 0, z}, {0, 0, 1})) {
            const Vec2 p = frame.at(a), q = frame.at(b);
            fmt::format_to(std::back_inserter(path), "M{:.1f} {:.1f}L{:.1f} {:.1f}", p.x, p.y, q.x, q.y);
        }
    }
    return path;
}

/// Path of the outlines of a luminaire's faces.
std::string outline_of(const Scene& scene, const std::vector<SurfaceId>& faces, const LayoutFrame& frame) {
    std::string path;
    for (const SurfaceId s : faces) {
        bool is_first = true;
        for (const Point& p : scene.outline(s)) {
            const Vec2 at = frame.at(p);
            fmt::format_to(std::back_inserter(path), "{}{:.1f} {:.1f}", is_first ? "M" : "L", at.x, at.y);
            is_first = false;
        }
        path += "Z";
    }
    return path;
}

/// Size of the letters of a label, in SVG units, so that it does not cover that of the nearest luminaire; 0 if no
/// readable size does.
double letters_at(const Vec2& at, std::span<const Vec2> places) {
    constexpr double largest = 20, smallest = 6;  // letter sizes, derived from print on A4
    constexpr double width_of_label = 3.2;        // in letter sizes; derived from labels of three or four letters
    double size = largest;
    for (const Vec2& other : places) {
        const double across = std::abs(other.x - at.x) / width_of_label, along = std::abs(other.y - at.y);
        if (across > 0 || along > 0) size = std::min(size, std::max(across, along));
    }
    return size < smallest ? 0 : size;
}

}  // namespace

std::string luminaire_plan(const ReportContent& content, const LuminaireSchedule& schedule, std::size_t room) {
    constexpr double cut_height = 1.0;  // metres above the floor; derived from the usual height at which plans are cut
    const Scene& scene = content.solution->scene;
    const LayoutFrame frame = frame_of(content.rooms[room]);
    const double z = content.rooms[room].rectangle.origin.z + std::min(cut_height, 0.5 * content.rooms[room].height);
    std::map<std::uint32_t, std::vector<SurfaceId>> faces;
    for (const SurfaceId s : scene.surfaces().ids()) faces[scene.surfaces()[s].group.value].push_back(s);
    std::vector<Vec2> places;
    for (const LuminaireSchedule::Item& item : schedule.items)
        if (item.room == room) places.push_back(frame.at(item.facts->position));
    std::string lamps, labels;
    for (const LuminaireSchedule::Item& item : schedule.items) {
        if (item.room != room) continue;
        const Vec2 at = frame.at(item.facts->position);
        lamps +=
            fmt::format("<path class=\"lamp\" d=\"{}\"/><circle class=\"lamp\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2\"/>",
                        outline_of(scene, faces[item.facts->group], frame), at.x, at.y);
        const double size = letters_at(at, places);
        if (size > 0)
            labels += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" style=\"font-size:{:.1f}px\">{}</text>", at.x,
                                  at.y + 0.35 * size, size, item.label);
    }
    return fmt::format(
        "<svg class=\"layout\" viewBox=\"0 0 {0:.1f} {1:.1f}\" style=\"max-width:{5:.0f}px\" role=\"img\" "
        "aria-label=\"layout of the luminaires\"><path "
        "class=\"cut\" d=\"{2}\"/>{3}{4}</svg>",
        frame.to_plan * frame.width, frame.to_plan * frame.height, cut_at(scene, frame, z), lamps, labels,
        shown_width(frame.width, frame.height));
}

}  // namespace exitance
