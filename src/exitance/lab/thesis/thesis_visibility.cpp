#include "exitance/lab/thesis/thesis_studies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <string>
#include <vector>

#include "exitance/base/random.hpp"
#include "exitance/lab/bsp/merged_volumes.hpp"
#include "exitance/lab/bsp/source_orderings.hpp"
#include "exitance/visibility/shaft.hpp"

namespace exitance {
namespace {

double cpu_seconds() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// ------------------------------------------------------------------------------------------------- candidates

struct Mean {
    double sum = 0;
    std::size_t count = 0;
    void add(std::size_t v) { sum += static_cast<double>(v), ++count; }
    double share(std::size_t of) const { return count > 0 ? sum / static_cast<double>(count * of) : 0; }
};

/// Adds candidate lists of points in penumbra, approximated by squares of a thousandth of the scene's size.
void add_points(const Occluders& occluders, std::span<const Point> outline, const ConvexPiece& piece,
                const Facet& source, RandomStream& random, Mean& lists) {
    constexpr int places = 8;
    const double half = 0.0005 * occluders.scene().size();
    const Frame frame(piece.plane.n);
    Shaft shaft;
    std::vector<PieceId> found;
    for (int i = 0; i < places; ++i) {
        Point p = outline[0];
        for (const Point& q : outline) p += random.uniform() * (q - p);
        const std::array<Point, 4> square{p + frame.to_world(-half, -half, 0), p + frame.to_world(half, -half, 0),
                                          p + frame.to_world(half, half, 0), p + frame.to_world(-half, half, 0)};
        shaft.set(occluders, {square, piece.plane.n, piece.region}, source);
        if (shaft.classify(found) == View::mixed) lists.add(found.size());
    }
}

void candidates(const char* name, const Scene& scene, CsvText& out) {
    const Occluders occluders(scene);
    const BspTree tree(occluders);
    constexpr std::size_t max_nodes = 400;
    const std::size_t step = std::max<std::size_t>(1, tree.nodes().size() / max_nodes);
    enum { penumbra, shadowed, lists };
    Mean bsp[lists], facing[lists], shaft_list[lists];
    Mean points;
    RandomStream random(1, Stream::mesh);
    std::size_t split_near_root = 0;
    std::size_t emitters = 0;
    constexpr std::size_t max_emitters = 8;
    for (SurfaceId s : scene.emitters()) {
        if (++emitters > max_emitters) break;
        const RegionId source_region = scene.surfaces()[s].region;
        const std::vector<Point> hull = convex_hull(scene.outline(s), scene.surfaces()[s].normal);
        if (hull.size() < 3 || hull.size() > 64) continue;
        const SourceOrderings orderings(tree, hull);
        for (const BspTree::Node& node : tree.nodes()) {
            if (node.depth > 3) continue;
            int sides = 0;
            for (const Point& p : hull) sides |= tree.side(node, p) > 0 ? 1 : tree.side(node, p) < 0 ? 2 : 0;
            split_near_root += sides == 3;
        }
        const Facet source{hull, scene.surfaces()[s].normal, source_region};
        Shaft shaft;
        std::vector<PieceId> found;
        for (std::size_t n = 0; n < tree.nodes().size(); n += step) {
            const BspTree::Node& node = tree.nodes()[n];
            bool is_penumbra = false, is_umbra = false;
            Mean longest;
            for (const BspTree::Fragment& f : tree.fragments(node)) {
                const ConvexPiece& piece = occluders.pieces()[f.piece];
                shaft.set(occluders, {tree.outline(f), piece.plane.n, piece.region}, source);
                const View view = shaft.classify(found);
                is_penumbra |= view == View::mixed;
                // Polygons that face away are classified as none as well, but are not in shadow.
                is_umbra |= view == View::none && !shaft.blocker().is_none();
                if (view == View::mixed) longest.add(found.size());
            }
            if (!is_penumbra && !is_umbra) continue;
            const std::size_t all = orderings.candidate_pieces(static_cast<std::uint32_t>(n)).size();
            const std::size_t front = orderings.candidate_pieces(static_cast<std::uint32_t>(n), true).size();
            const auto ours =
                static_cast<std::size_t>(longest.count > 0 ? longest.sum / static_cast<double>(longest.count) : 1);
            Mean of_points;
            for (const BspTree::Fragment& f : tree.fragments(node))
                add_points(occluders, tree.outline(f), occluders.pieces()[f.piece], source, random, of_points);
            points.sum += of_points.sum, points.count += of_points.count;
            for (int list = is_penumbra ? penumbra : shadowed; list < lists; ++list)
                bsp[list].add(all), facing[list].add(front), shaft_list[list].add(ours);
        }
    }
    const std::size_t pieces = occluders.pieces().size();
    for (int list = 0; list < lists; ++list)
        out.print("%s,%zu,%zu,%zu,%zu,%zu,%s,%zu,%.4f,%.4f,%.4f,%.4f\n", name, pieces, tree.nodes().size(),
                  tree.fragments().size(), tree.depth(), split_near_root,
                  list == penumbra ? "penumbra" : "penumbra+umbra", bsp[list].count, bsp[list].share(pieces),
                  facing[list].share(pieces), shaft_list[list].share(pieces), points.share(pieces));
}

// ---------------------------------------------------------------------------------------------- shadow volumes

/// Results of one kind of volumes for pairs, and their cost.
struct VolumeCounts {
    std::size_t survivors = 0, tests = 0, umbra = 0;
    double making = 0, testing = 0;  ///< Processor time, s.
};

/// Counts the polygons that survive for every pair of a source and a polygon that light may reach: by separate volumes,
/// by volumes merged into one tree per source, and by shafts.
class VolumeStudy {
  public:
    explicit VolumeStudy(const Scene& scene) : scene_(scene), occluders_(scene) {
        constexpr std::size_t max_emitters = 4;
        for (std::size_t e = 0; e < std::min(max_emitters, scene.emitters().size()); ++e) look(scene.emitters()[e]);
    }

    void print(const char* name, CsvText& out) const {
        const double each = pairs_ > 0 ? 1.0 / static_cast<double>(pairs_) : 0;
        const double a_volume = 1e6 / static_cast<double>(std::max<std::size_t>(1, made_));
        const auto per_pair = [&](std::size_t count) { return each * static_cast<double>(count); };
        out.print("%s,%zu,%zu,%zu,%.2f,%.2f,%.1f,%zu,%zu,%.2f,%.2f,%.2f,", name, occluders_.pieces().size(), pairs_,
                  made_, per_pair(apart_.survivors), per_pair(of_shafts_), per_pair(apart_.tests), apart_.umbra,
                  hidden_, a_volume * apart_.making, 1e6 * each * apart_.testing, 1e6 * each * shaft_seconds_);
        out.print("%.2f,%.1f,%zu,%zu,%zu,%.2f,%.2f\n", per_pair(merged_.survivors), per_pair(merged_.tests),
                  merged_.umbra, nodes_, unmerged_, a_volume * merged_.making, 1e6 * each * merged_.testing);
    }

  private:
    using Volumes = std::vector<std::pair<PieceId, ShadowVolume>>;

    bool is_own(PieceId p, RegionId region) const { return occluders_.is_own(occluders_.pieces()[p].region, region); }

    void look(SurfaceId source) {
        const Surface& emitter = scene_.surfaces()[source];
        const std::vector<Point> hull = convex_hull(scene_.outline(source), emitter.normal);
        Volumes all;
        double begin = cpu_seconds();
        for (PieceId p : occluders_.pieces().ids()) {
            if (is_own(p, emitter.region)) continue;
            ShadowVolume volume(hull, scene_.regions()[emitter.region].plane, occluders_.corners(p),
                                occluders_.pieces()[p].plane, occluders_.rounding());
            if (!volume.is_empty()) all.emplace_back(p, std::move(volume));
        }
        apart_.making += cpu_seconds() - begin, made_ += all.size();
        begin = cpu_seconds();
        MergedVolumes tree(scene_.box(), occluders_.rounding());
        for (const auto& [p, volume] : all) tree.add(volume);
        merged_.making += cpu_seconds() - begin, nodes_ += tree.nodes(), unmerged_ += tree.unmerged();
        Shaft shaft;
        std::vector<PieceId> found;
        for (PieceId r : occluders_.pieces().ids()) {
            if (is_own(r, emitter.region)) continue;
            const ConvexPiece& piece = occluders_.pieces()[r];
            begin = cpu_seconds();
            shaft.set(occluders_, {occluders_.corners(r), piece.plane.n, piece.region},
                      {hull, emitter.normal, emitter.region});
            const View view = shaft.classify(found);
            shaft_seconds_ += cpu_seconds() - begin;
            if (view == View::none && shaft.blocker().is_none()) continue;  // facing away
            ++pairs_;
            of_shafts_ += view == View::mixed ? found.size() : view == View::none ? 1 : 0;
            hidden_ += view == View::none;
            ask_apart(all, r);
            ask_merged(all, tree, r);
        }
    }

    void ask_apart(const Volumes& all, PieceId r) {
        const double begin = cpu_seconds();
        const auto corners = occluders_.corners(r);
        bool is_umbra = false;
        for (const auto& [p, volume] : all) {
            if (occluders_.pieces()[p].region == occluders_.pieces()[r].region) continue;
            if (volume.in_penumbra(corners, apart_.tests) == ShadowVolume::Place::outside) continue;
            ++apart_.survivors;
            is_umbra |= volume.in_umbra(corners, apart_.tests) == ShadowVolume::Place::inside;
        }
        apart_.testing += cpu_seconds() - begin, apart_.umbra += is_umbra;
    }

    void ask_merged(const Volumes& all, const MergedVolumes& tree, PieceId r) {
        const double begin = cpu_seconds();
        tree.classify(occluders_.corners(r), classes_, merged_.tests);
        for (const std::uint32_t i : classes_.reached)
            merged_.survivors += occluders_.pieces()[all[i].first].region != occluders_.pieces()[r].region;
        merged_.testing += cpu_seconds() - begin, merged_.umbra += classes_.is_hidden;
    }

    const Scene& scene_;
    Occluders occluders_;
    MergedVolumes::Classes classes_;
    VolumeCounts apart_, merged_;
    std::size_t pairs_ = 0, of_shafts_ = 0, hidden_ = 0, made_ = 0, nodes_ = 0, unmerged_ = 0;
    double shaft_seconds_ = 0;
};

void volumes(const char* name, const Scene& scene, CsvText& out) {
    VolumeStudy(scene).print(name, out);
}

// ------------------------------------------------------------------------------------------------------- rays

void rays(const char* name, const Scene& scene, CsvText& out) {
    constexpr std::size_t count = 1'000'000;
    const Occluders occluders(scene);
    double begin = cpu_seconds();
    const BspTree tree(occluders);
    const double built = cpu_seconds() - begin;
    const RayTracer tracer(scene);
    RandomStream random(1, Stream::mesh);
    const Vec3 size = scene.box().size();
    std::vector<Point> origins(count);
    std::vector<Vec3> directions(count);
    for (std::size_t i = 0; i < count; ++i) {
        origins[i] =
            scene.box().lo + Vec3{random.uniform() * size.x, random.uniform() * size.y, random.uniform() * size.z};
        const double z = 2 * random.uniform() - 1;
        directions[i] = direction_at(z, random.uniform());
    }
    std::vector<RayHit> expected(count);
    begin = cpu_seconds();
    tracer.nearest(origins, directions, RegionId(), expected);
    const double embree = cpu_seconds() - begin;
    std::vector<BspTree::Hit> hits(count);
    begin = cpu_seconds();
    for (std::size_t i = 0; i < count; ++i) hits[i] = tree.nearest(origins[i], directions[i]);
    const double bsp = cpu_seconds() - begin;
    std::size_t same = 0, same_distance = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const bool none = hits[i].piece.is_none() && expected[i].surface.is_none();
        const bool near = none || std::abs(hits[i].distance - expected[i].distance) < 1e-5 * scene.size();
        same_distance += near;
        same += none ||
                (near && !hits[i].piece.is_none() && occluders.pieces()[hits[i].piece].region == expected[i].region);
    }
    out.print("%s,%zu,%zu,%zu,%.3f,%.3g,%.3g,%zu,%zu\n", name, occluders.pieces().size(), tree.fragments().size(),
              tree.memory_bytes(), built, static_cast<double>(count) / bsp, static_cast<double>(count) / embree,
              count - same, count - same_distance);
}

}  // namespace

std::span<const SceneStudy> thesis_visibility_studies() {
    static constexpr SceneStudy studies[] = {
        {"candidates",
         "scene,polygons,nodes,fragments,depth,source_splits_to_depth_3,lists,count,bsp_share,bsp_facing_share,shaft_"
         "share,shaft_share_of_points",
         candidates},
        {"volumes",
         "scene,polygons,pairs,volumes,volume_survivors,shaft_survivors,plane_tests,umbra_by_volume,hidden_by_shaft,us_"
         "a_volume,us_testing,us_a_shaft,merged_survivors,merged_plane_tests,umbra_by_merged,merged_nodes,unmerged,us_"
         "merging_a_volume,us_testing_merged",
         volumes},
        {"rays",
         "scene,polygons,fragments,bytes,build_seconds,bsp_rays_per_second,embree_rays_per_second,other_hits,other_"
         "distances",
         rays},
    };
    return studies;
}

}  // namespace exitance
