#include "exitance/io/pictures/check_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "exitance/base/limits.hpp"
#include "exitance/base/polygon.hpp"
#include "exitance/base/triangulation.hpp"
#include "exitance/io/pictures/text.hpp"

namespace exitance {
namespace {

constexpr int legend_height = 26;

struct Look {
    const char* name;
    Rgb colour;
};
/// Indexed by Mark::Kind.
constexpr std::array<Look, 5> looks = {{{"broken", {220, 20, 30}},
                                        {"left out", {240, 140, 0}},
                                        {"covering", {190, 30, 200}},
                                        {"turned", {20, 90, 230}},
                                        {"open edge", {0, 150, 70}}}};

/// A parallel projection of a box into a rectangle of the picture.
class SceneView {
  public:
    SceneView(Image& image, const Box& box, const Vec3& from, int left, int width, int height)
        : image_(image), left_(left), width_(width), height_(height), towards_(normalized(from)) {
        right_ = normalized(cross({0, 0, 1}, towards_));
        up_ = cross(towards_, right_);
        double across = 0, along = 0;
        for (int i = 0; i < 8; ++i) {
            const Vec3 d =
                Point{i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y, i & 4 ? box.hi.z : box.lo.z} -
                box.centre();
            across = std::max(across, std::abs(dot(d, right_)));
            along = std::max(along, std::abs(dot(d, up_)));
        }
        constexpr double margin = 0.94;
        scale_ = 0.5 * margin * std::min(width / std::max(across, min_divisor), height / std::max(along, min_divisor));
        middle_ = box.centre();
        depth_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), -HUGE_VALF);
    }

    void draw_face(std::span<const Point> outline);
    void draw_mark(std::span<const Point> outline, Rgb colour);

  private:
    struct Seen {
        double x, y, depth;
    };
    Seen see(const Point& p) const {
        const Vec3 d = p - middle_;
        return {0.5 * width_ + scale_ * dot(d, right_), 0.5 * height_ - scale_ * dot(d, up_),
                scale_ * dot(d, towards_)};
    }
    void fill(const Seen& a, const Seen& b, const Seen& c, Rgb colour);
    void put(int x, int y, Rgb colour) {
        if (x >= 0 && y >= 0 && x < width_ && y < height_)
            std::copy(colour.begin(), colour.end(), image_.at(left_ + x, y));
    }

    Image& image_;
    int left_, width_, height_;
    Vec3 towards_, right_, up_;  ///< Direction towards the eye, and the picture's axes.
    Point middle_;
    double scale_ = 1;
    std::vector<float> depth_;  ///< Distance towards the eye, in pixels.
};

void SceneView::fill(const Seen& a, const Seen& b, const Seen& c, Rgb colour) {
    const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    if (area == 0 || !std::isfinite(area)) return;
    const auto bound = [](double v, int most) {
        return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(most)));
    };
    const int x0 = bound(std::min({a.x, b.x, c.x}), width_), x1 = bound(std::max({a.x, b.x, c.x}) + 1, width_);
    const int y0 = bound(std::min({a.y, b.y, c.y}), height_), y1 = bound(std::max({a.y, b.y, c.y}) + 1, height_);
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
            const double px = x + 0.5, py = y + 0.5;
            const double u = ((px - a.x) * (c.y - a.y) - (c.x - a.x) * (py - a.y)) / area;
            const double v = ((b.x - a.x) * (py - a.y) - (px - a.x) * (b.y - a.y)) / area;
            if (u < 0 || v < 0 || u + v > 1) continue;
            const auto depth = static_cast<float>(a.depth + u * (b.depth - a.depth) + v * (c.depth - a.depth));
            float& nearest =
                depth_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
            if (depth > nearest) nearest = depth, put(x, y, colour);
        }
}

void SceneView::draw_face(std::span<const Point> outline) {
    const Vec3 area = area_vector(outline);
    const double length = norm(area), facing = dot(area, towards_) / length;
    if (!(length > 0) || !(facing > 0)) return;
    const auto shade = static_cast<std::uint8_t>(110 + 120 * facing);
    for (const auto& t : triangulate(outline, area / length))
        fill(see(outline[t[0]]), see(outline[t[1]]), see(outline[t[2]]), {shade, shade, shade});
}

/// Draws an outline three pixels wide on top of everything.
void SceneView::draw_mark(std::span<const Point> outline, Rgb colour) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Seen a = see(outline[i]), b = see(outline[(i + 1) % outline.size()]);
        const double steps = std::min(1 + std::max(std::abs(b.x - a.x), std::abs(b.y - a.y)), 1e4);
        if (!std::isfinite(steps)) continue;
        for (double k = 0; k <= steps; ++k) {
            const int x = static_cast<int>(a.x + k / steps * (b.x - a.x)),
                      y = static_cast<int>(a.y + k / steps * (b.y - a.y));
            for (int dx = -1; dx <= 1; ++dx)
                for (int dy = -1; dy <= 1; ++dy) put(x + dx, y + dy, colour);
        }
    }
}

void draw_legend(Image& image, std::span<const Mark> marks) {
    constexpr Rgb ink = {20, 20, 20};
    constexpr int size = 14;
    const int y = image.height - legend_height + 6;
    int x = 12;
    for (std::size_t kind = 0; kind < looks.size(); ++kind) {
        const auto count = std::count_if(marks.begin(), marks.end(),
                                         [&](const Mark& m) { return static_cast<std::size_t>(m.kind) == kind; });
        const std::string text = std::string(looks[kind].name) + " " + std::to_string(count);
        fill_rectangle(image, x, y, 14, 14, looks[kind].colour);
        draw_text(image, x + 20, y + 2, text, size, ink);
        x += 20 + text_width(text, size) + 24;
    }
}

}  // namespace

Image check_picture(const SceneDescription& scene, std::span<const Mark> marks, int width, int height) {
    Image image(width, height);
    std::fill(image.rgb.begin(), image.rgb.end(), std::uint8_t(250));
    std::vector<std::vector<Point>> outlines;
    Box box;
    for (const SceneDescription::Face& face : scene.faces) {
        std::vector<Point>& outline = outlines.emplace_back();
        for (const std::uint32_t c : face.corners)
            if (c < scene.points.size() && is_finite(scene.points[c])) outline.push_back(scene.points[c]);
        for (const Point& p : outline) box.add(p);
        if (outline.size() < 3) outlines.pop_back();
    }
    if (!box.is_empty()) {
        const int half = width / 2, inner = height - legend_height;
        for (int side = 0; side < 2; ++side) {
            const double turn = side == 0 ? 1 : -1;
            SceneView view(image, box, {0.6 * turn, -0.9 * turn, 0.75}, side * half, half, inner);
            for (const auto& outline : outlines) view.draw_face(outline);
            for (std::size_t kind = looks.size(); kind-- > 0;)  // the most serious kind last, on top
                for (const Mark& mark : marks)
                    if (static_cast<std::size_t>(mark.kind) == kind) view.draw_mark(mark.outline, looks[kind].colour);
        }
    }
    draw_legend(image, marks);
    return image;
}

}  // namespace exitance
