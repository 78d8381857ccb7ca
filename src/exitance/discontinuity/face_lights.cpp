#include "exitance/discontinuity/face_lights.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace exitance {
namespace {

class Halves {
  public:
    Halves(const DirectLight& direct, const FaceOutlines& outlines, std::span<ReceiverLight> lights,
           const StopRequest& stop, DirectLight::Workspace& workspace)
        : direct_(direct), outlines_(outlines), lights_(lights), stop_(stop), workspace_(workspace) {
        order_.resize(outlines.faces.size());
        std::iota(order_.begin(), order_.end(), 0u);
    }

    void run(const ReceiverLight& whole) { divide(order_, whole); }

  private:
    /// Coordinate along an axis of the plane, relative to the first face's first corner.
    double along(const Vec3& axis, const Point& p) const { return dot(axis, p - outlines_.faces[0][0]); }

    void divide(std::span<std::uint32_t> faces, const ReceiverLight& above) {
        // Up to these numbers of faces or candidates, another common search costs as much as it saves.
        constexpr std::size_t max_single_faces = 4, max_single_candidates = 64;
        if (stop_.requested()) return;
        if (faces.size() <= max_single_faces || above.candidates.size() <= max_single_candidates) {
            for (const std::uint32_t f : faces) direct_.prepare(outlines_.faces[f], above, lights_[f], workspace_);
            return;
        }
        double lo[2] = {HUGE_VAL, HUGE_VAL}, hi[2] = {-HUGE_VAL, -HUGE_VAL};
        const Vec3 axes[2] = {outlines_.u, outlines_.v};
        for (const std::uint32_t f : faces)
            for (const Point& p : outlines_.faces[f])
                for (int k = 0; k < 2; ++k)
                    lo[k] = std::min(lo[k], along(axes[k], p)), hi[k] = std::max(hi[k], along(axes[k], p));
        ReceiverLight here;
        const bool is_whole = faces.size() == order_.size();
        if (!is_whole) {
            const auto corner = [&](double s, double t) {
                return outlines_.faces[0][0] + s * outlines_.u + t * outlines_.v;
            };
            const Point rectangle[4] = {corner(lo[0], lo[1]), corner(hi[0], lo[1]), corner(hi[0], hi[1]),
                                        corner(lo[0], hi[1])};
            direct_.prepare(rectangle, above, here, workspace_);
        }
        const Vec3& axis = axes[hi[0] - lo[0] >= hi[1] - lo[1] ? 0 : 1];
        const auto middle = faces.begin() + static_cast<std::ptrdiff_t>(faces.size() / 2);
        const auto place = [&](std::uint32_t f) {
            double sum = 0;
            for (const Point& p : outlines_.faces[f]) sum += along(axis, p);
            return sum / static_cast<double>(outlines_.faces[f].size());
        };
        std::nth_element(faces.begin(), middle, faces.end(), [&](std::uint32_t a, std::uint32_t b) {
            return std::pair(place(a), a) < std::pair(place(b), b);
        });
        divide({faces.begin(), middle}, is_whole ? above : here);
        divide({middle, faces.end()}, is_whole ? above : here);
    }

    const DirectLight& direct_;
    const FaceOutlines& outlines_;
    std::span<ReceiverLight> lights_;
    const StopRequest& stop_;
    DirectLight::Workspace& workspace_;
    std::vector<std::uint32_t> order_;
};

}  // namespace

void prepare_face_lights(const DirectLight& direct, const FaceOutlines& outlines, const ReceiverLight& whole,
                         std::span<ReceiverLight> lights, const StopRequest& stop, DirectLight::Workspace& workspace) {
    for (ReceiverLight& light : lights) light.n = whole.n, light.own = whole.own;
    if (!whole.is_dark()) Halves(direct, outlines, lights, stop, workspace).run(whole);
}

std::vector<Point> shrunk_triangle(const std::array<Point, 3>& corners, double distance) {
    const auto& [a, b, c] = corners;
    const double at_a = norm(c - b), at_b = norm(a - c), at_c = norm(b - a), around = at_a + at_b + at_c;
    const double inradius = norm(cross(b - a, c - a)) / around;
    std::vector<Point> out(corners.begin(), corners.end());
    if (!(inradius > 2 * distance)) return out;
    const Point incentre = a + (at_b / around) * (b - a) + (at_c / around) * (c - a);
    for (Point& p : out) p += (distance / inradius) * (incentre - p);
    return out;
}

}  // namespace exitance
