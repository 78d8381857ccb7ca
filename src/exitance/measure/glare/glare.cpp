#include "exitance/measure/glare/glare.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "exitance/base/triangulation.hpp"
#include "exitance/measure/glare/eye_light.hpp"
#include "exitance/measure/glare/view_triangle.hpp"
#include "exitance/scene/point_opening.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {
namespace {

constexpr double near = 0.01;          ///< Metres; nearer faces of one group belong to one luminaire.
constexpr double largest_angle = 0.1;  ///< sr; the largest solid angle for which UGR is defined.

/// A part of a face that is small as seen from the eye.
struct Piece {
    Point middle;
    double area = 0, solid_angle = 0;
};

void cut(const Point& eye, const Point& a, const Point& b, const Point& c, int depth, std::vector<Piece>& out) {
    constexpr double fine = 2e-4;  // sr
    constexpr int min_depth = 2, max_depth = 6;
    const double angle = solid_angle(a - eye, b - eye, c - eye);
    if (depth >= max_depth || (depth >= min_depth && angle <= fine)) {
        out.push_back({(a + b + c) / 3, 0.5 * norm(cross(b - a, c - a)), angle});
        return;
    }
    const Point ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
    cut(eye, a, ab, ca, depth + 1, out), cut(eye, ab, b, bc, depth + 1, out);
    cut(eye, ca, bc, c, depth + 1, out), cut(eye, ab, bc, ca, depth + 1, out);
}

/// Groups emitting faces into luminaires.
std::vector<std::vector<SurfaceId>> luminaires(const Scene& scene) {
    struct Entry {
        SurfaceId surface;
        Box box;
    };
    std::vector<Entry> faces;
    for (const SurfaceId s : scene.emitters()) {
        faces.push_back({s, {}});
        for (const Point& p : scene.outline(s)) faces.back().box.add(p);
    }
    std::stable_sort(faces.begin(), faces.end(),
                     [](const Entry& a, const Entry& b) { return a.box.lo.x < b.box.lo.x; });
    std::vector<std::size_t> root(faces.size());
    std::iota(root.begin(), root.end(), std::size_t{0});
    const auto find = [&](std::size_t i) {
        while (root[i] != i) i = root[i] = root[root[i]];
        return i;
    };
    const auto touch = [](const Box& a, const Box& b) {
        for (std::size_t k = 0; k < 3; ++k)
            if (a.lo[k] > b.hi[k] + near || b.lo[k] > a.hi[k] + near) return false;
        return true;
    };
    for (std::size_t a = 0; a < faces.size(); ++a)
        for (std::size_t b = a + 1; b < faces.size() && faces[b].box.lo.x <= faces[a].box.hi.x + near; ++b)
            if (scene.surfaces()[faces[a].surface].group == scene.surfaces()[faces[b].surface].group &&
                touch(faces[a].box, faces[b].box))
                root[find(a)] = find(b);
    std::vector<std::vector<SurfaceId>> out;
    std::vector<std::size_t> number(faces.size(), faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i) {
        std::size_t& at = number[find(i)];
        if (at == faces.size()) at = out.size(), out.emplace_back();
        out[at].push_back(faces[i].surface);
    }
    return out;
}

/// Share of light that the panes between two points transmit.
Spectrum through_panes(const Scene& scene, const Point& from, const Point& to) {
    Spectrum share(1);
    for (const Pane& pane : scene.panes()) {
        const double a = dot(pane.n, from - pane.corners[0]), b = dot(pane.n, to - pane.corners[0]);
        if ((a > 0) == (b > 0)) continue;
        if (!contains(pane.corners, pane.n, from + a / (a - b) * (to - from))) continue;
        share *= pane.transmission(std::abs(dot(pane.n, normalized(to - from))));
    }
    return share;
}

class Eye {
  public:
    Eye(const RadiosityFunction& light, const Observer& observer, const LightUnit& lux)
        : stage_(light.stage()), scene_(light.solution().scene), observer_(observer), lux_(lux) {}

    /// Returns a luminaire as seen from the eye; without solid angle if it is not visible.
    GlareSource source(const std::vector<SurfaceId>& faces) const {
        GlareSource out;
        Vec3 middle;
        double area = 0, sum = 0;
        for (const SurfaceId s : faces) add_face(s, out.solid_angle, sum, middle, area);
        if (!(out.solid_angle > 0)) return out;
        out.name = scene_.groups()[scene_.surfaces()[faces[0]].group];
        const Vec3 d = middle / area - observer_.eye;
        if (is_point(area)) out.solid_angle = small_source_area / dot(d, d);
        out.luminance = sum / out.solid_angle;
        place(d, hangs_above(faces), out);
        return out;
    }

    GlareSource source(const PunctualLight& lamp) const {
        GlareSource out;
        const Vec3 d = lamp.position - observer_.eye;
        if (lamp.is_directional() || !(dot(d, observer_.view) > 0)) return out;
        bool blocked = false;
        stage_.tracer.occluded(std::span(&observer_.eye, 1), std::span(&lamp.position, 1), RegionId(), RegionId(),
                               std::span(&blocked, 1));
        if (blocked) return out;
        const Spectrum passing = through_panes(scene_, observer_.eye, lamp.position);
        out.name = lamp.name;
        out.luminance = lux_(passing * lamp.intensity) * lamp.share_towards(-1 * normalized(d)) / small_source_area;
        out.solid_angle = small_source_area / dot(d, d);
        place(d, d.z > 0, out);
        return out;
    }

  private:
    /// True if an area is at most that of the visible faces of a cube that represents a luminaire without extent.
    static bool is_point(double area) {
        constexpr double rounding = 1e-6;
        // three of the cube's faces are visible
        return area <= 3 * point_opening_size * point_opening_size * (1 + rounding);
    }

    /// True if all corners of the faces are above the height of the eye.
    bool hangs_above(const std::vector<SurfaceId>& faces) const {
        return std::all_of(faces.begin(), faces.end(), [&](SurfaceId s) {
            const std::span<const Point> outline = scene_.outline(s);
            return std::all_of(outline.begin(), outline.end(), [&](const Point& p) { return p.z > observer_.eye.z; });
        });
    }

    void place(const Vec3& d, bool hangs_above, GlareSource& out) const {
        out.position = guth_position(observer_.view, d);
        out.limit = glare_limit(observer_.view, d, hangs_above);
    }

    void add_face(SurfaceId s, double& angle, double& sum, Vec3& middle, double& area) const {
        const Surface& surface = scene_.surfaces()[s];
        const std::span<const Point> outline = scene_.outline(s);
        if (dot(surface.normal, observer_.eye - outline[0]) <= 0) return;
        std::vector<Piece> pieces;
        for (const auto& t : triangulate(outline, surface.normal))
            cut(observer_.eye, outline[t[0]], outline[t[1]], outline[t[2]], 0, pieces);
        std::erase_if(pieces, [&](const Piece& p) { return !(dot(p.middle - observer_.eye, observer_.view) > 0); });
        std::vector<Point> from(pieces.size(), observer_.eye), to;
        for (const Piece& p : pieces) to.push_back(p.middle);
        const std::unique_ptr<bool[]> blocked(new bool[pieces.size() + 1]);
        stage_.tracer.occluded(from, to, RegionId(), surface.region, std::span(blocked.get(), pieces.size()));
        const RelativeRadiance relative = scene_.relative_radiance(surface.region);
        const Spectrum radiance = radiance_of_exitance(scene_.material(s).exitance);
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            if (blocked[i]) continue;
            const Piece& p = pieces[i];
            const Spectrum passing = through_panes(scene_, observer_.eye, p.middle);
            angle += p.solid_angle, area += p.area, middle += p.area * p.middle;
            sum += p.solid_angle * lux_(passing * radiance) * relative.towards(observer_.eye, p.middle);
        }
    }

    const Stage& stage_;
    const Scene& scene_;
    const Observer& observer_;
    const LightUnit& lux_;
};

}  // namespace

double Glare::rating() const {
    double sum = 0;
    for (const GlareSource& source : sources) sum += source.term();
    return 8 * std::log10(0.25 / background * sum);
}

bool Glare::has_large_source() const {
    return std::any_of(sources.begin(), sources.end(),
                       [](const GlareSource& source) { return source.solid_angle > largest_angle; });
}

Glare find_glare(const RadiosityFunction& light, const Observer& at, const LightUnit& lux) {
    const Scene& scene = light.solution().scene;
    const Observer observer = off_walls(light, at);
    const Eye eye(light, observer, lux);
    Glare out;
    const auto add = [&](GlareSource source) {
        if (source.term() > 0)
            (source.limit == GlareLimit::none ? out.sources : out.left_out).push_back(std::move(source));
    };
    for (const std::vector<SurfaceId>& faces : luminaires(scene)) add(eye.source(faces));
    for (const PunctualLight& lamp : scene.lights()) add(eye.source(lamp));
    for (std::vector<GlareSource>* sources : {&out.sources, &out.left_out})
        std::stable_sort(sources->begin(), sources->end(),
                         [](const GlareSource& a, const GlareSource& b) { return a.term() > b.term(); });
    out.background = indirect_at_eye(light, observer, lux) / pi;
    return out;
}

}  // namespace exitance
