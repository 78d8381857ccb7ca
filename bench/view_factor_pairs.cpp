// Checks entries of a matrix of view factors against independent references:
//
//     exitance-view-factor-pairs SCENE.obj [PAIRS=200 [SEED=1 [TOLERANCE=1e-4]]]
//
// Draws pairs of faces with F > 1e-5. A reference is the mean exact form factor to the visible part of the source, with
// every face of the scene a possible blocker, over 16 times 1024 scrambled Sobol points of the receiver (32768 if the
// error is still above 2e-4). It uses no critical lines, no cells, and no adaptive rules. The spread of the sixteen
// means is its standard error.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <span>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/view_factors/entry_factors.hpp"
#include "exitance/visibility/visible_part.hpp"

namespace {

using namespace exitance;

/// The faces of a scene with separate materials, so that none are merged.
Scene with_faces_apart(const Scene& scene) {
    SceneDescription out;
    out.groups = {"all"};
    for (SurfaceId s : scene.surfaces().ids()) {
        SceneDescription::Face face;
        for (const Point& p : scene.outline(s)) {
            face.corners.push_back(static_cast<std::uint32_t>(out.points.size()));
            out.points.push_back(p);
        }
        face.material = s.value;
        const double rho = 0.9 * (s.value + 1.0) / static_cast<double>(scene.surfaces().size());
        out.materials.push_back({std::to_string(s.value), Spectrum(rho), Spectrum()});
        out.faces.push_back(face);
    }
    CheckedScene checked = make_scene(std::move(out));
    EXI_CHECK(static_cast<bool>(checked.scene));
    return std::move(*checked.scene);
}

struct Reference {
    double F = 0, standard_error = 0;
};

/// Reference for a convex face and another face that it sees.
Reference long_reference(const Scene& scene, const Occluders& occluders, SurfaceId i, SurfaceId j,
                         std::uint32_t points) {
    constexpr std::uint32_t repetitions = 16;
    const RegionId own = scene.surfaces()[i].region, other = scene.surfaces()[j].region;
    const std::span<const Point> outline = scene.outline(i);
    const Normal n = scene.surfaces()[i].normal;
    std::vector<double> until = {0};  // area of the fan of triangles so far
    for (std::size_t k = 2; k < outline.size(); ++k)
        until.push_back(until.back() + 0.5 * norm(cross(outline[k - 1] - outline[0], outline[k] - outline[0])));
    VisibilityWorkspace scratch;
    std::array<double, repetitions> mean{};
    for (std::uint32_t repetition = 0; repetition < repetitions; ++repetition) {
        const ScrambledSobol sobol(hash(i.value, j.value, repetition));
        for (std::uint32_t k = 0; k < points; ++k) {
            const double area = sobol(k, 0) * until.back();
            const auto t = std::min<std::size_t>(
                static_cast<std::size_t>(std::upper_bound(until.begin(), until.end(), area) - until.begin()) - 1,
                until.size() - 2);
            const double s = std::sqrt((area - until[t]) / (until[t + 1] - until[t])), v = sobol(k, 1);
            const Point x =
                outline[0] + s * ((1 - v) * (outline[t + 1] - outline[0]) + v * (outline[t + 2] - outline[0]));
            for (PieceId piece : occluders.pieces(other))
                mean[repetition] += visible_form_factor(occluders, {x, n, own}, piece, scratch) / points;
        }
    }
    Reference out;
    for (double m : mean) out.F += m / repetitions;
    for (double m : mean) out.standard_error += (m - out.F) * (m - out.F) / (repetitions * (repetitions - 1.0));
    out.standard_error = std::sqrt(out.standard_error);
    return out;
}

int run(const char* name, std::size_t count, std::uint64_t seed, double tolerance) {
    const CheckedScene checked = load_scene(name);
    if (!checked.scene) return std::fprintf(stderr, "%s\n", checked.scene.error().message.c_str()), 3;
    const Scene scene = with_faces_apart(*checked.scene);
    const Occluders occluders(scene);
    Progress progress;
    const SparseFactors table =
        compute_entry_factors(scene, {.tolerance = tolerance}, nullptr, progress, StopRequest());
    const auto entry = [&](SurfaceId i, SurfaceId j) {
        const std::span<const std::uint32_t> columns = table.row_columns(i.value);
        const auto at = std::lower_bound(columns.begin(), columns.end(), j.value);
        const bool is_stored = at != columns.end() && *at == j.value;
        return is_stored ? table.row_values(i.value)[static_cast<std::size_t>(at - columns.begin())] : 0;
    };

    RandomStream random(seed, Stream::mesh);
    const double n = static_cast<double>(table.size());
    std::vector<std::pair<SurfaceId, SurfaceId>> pairs;
    while (pairs.size() < count) {
        const SurfaceId i(static_cast<std::size_t>(n * random.uniform())),
            j(static_cast<std::size_t>(n * random.uniform()));
        if (entry(i, j) > 1e-5) pairs.push_back({i, j});
    }
    std::vector<Reference> references(count);
    parallel_for(count, 1, [&](std::size_t k) {
        for (const std::uint32_t points : {1024, 32768}) {
            references[k] = long_reference(scene, occluders, pairs[k].first, pairs[k].second, points);
            if (references[k].standard_error < 2e-4 * references[k].F) break;
        }
    });
    double worst = 0, noisiest = 0;
    std::size_t wrong = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const auto [i, j] = pairs[k];
        const auto [F, standard_error] = references[k];
        const double found = entry(i, j), error = std::abs(found / F - 1), noise = standard_error / F;
        worst = std::max(worst, error), noisiest = std::max(noisiest, noise);
        if (error <= 1e-3 + 3 * noise) continue;
        ++wrong;
        std::printf("F(%u, %u) = %.8g, reference %.8g +- %.2g\n", i.value + 1, j.value + 1, found, F, standard_error);
    }
    std::printf(
        "%zu pairs: %zu off by more than 0.1%% and three standard errors; largest difference %.4f%%, largest "
        "standard error %.4f%%\n",
        count, wrong, 100 * worst, 100 * noisiest);
    return wrong > 0;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) return std::fprintf(stderr, "exitance-view-factor-pairs SCENE.obj [PAIRS [SEED [TOLERANCE]]]\n"), 2;
    return run(argv[1], argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 200,
               argc > 3 ? std::strtoul(argv[3], nullptr, 10) : 1, argc > 4 ? std::atof(argv[4]) : 1e-4);
}
