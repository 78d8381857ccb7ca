#include "exitance/lab/studies/cell_growth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/lab/flatland/growing_lines.hpp"
#include "exitance/lab/growing_cells/cell_function.hpp"
#include "exitance/lab/studies/sample_distribution.hpp"
#include "exitance/lab/study/study_drawings.hpp"
#include "exitance/methods/solve_scene.hpp"

namespace exitance {
namespace {

constexpr const char* outline_colour = "#999999";
constexpr const char* ray_colour = "#c8553d";
constexpr const char* uniform_colour = "#777777";

/// Coordinates in the picture plane of a parallel projection along (-1, -1, -1), and the depth towards the eye.
struct Projected {
    double u, v, depth;
};
Projected project(const Point& p) {
    static const double across = 1 / std::sqrt(2.0), up = 1 / std::sqrt(6.0);
    return {across * (p.y - p.x), up * (2 * p.z - p.x - p.y), p.x + p.y + p.z};
}

void add_outlines(const Scene& scene, const std::string& drawing, Table& out) {
    for (const SurfaceId s : scene.surfaces().ids()) {
        const auto& corners = scene.outline(s);
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const Projected a = project(corners[i]), b = project(corners[(i + 1) % corners.size()]);
            add_shape(out, drawing, "line", {a.u, a.v, b.u, b.v}, outline_colour);
        }
    }
}

/// Triangles of the shading network from back to front, coloured by the square root of their light.
void add_triangles(const CellLight& light, const std::string& drawing, Table& out) {
    double most = 0;
    for (const CellLight::Cell& cell : light.cells) most = std::max(most, mean(cell.value));
    auto triangles = light.triangles;
    const auto depth = [&](const auto& t) {
        return project(light.cells[t[0]].at).depth + project(light.cells[t[1]].at).depth +
               project(light.cells[t[2]].at).depth;
    };
    std::stable_sort(triangles.begin(), triangles.end(),
                     [&](const auto& a, const auto& b) { return depth(a) < depth(b); });
    for (const auto& t : triangles) {
        const Projected a = project(light.cells[t[0]].at), b = project(light.cells[t[1]].at);
        const Projected c = project(light.cells[t[2]].at);
        const double value =
            (mean(light.cells[t[0]].value) + mean(light.cells[t[1]].value) + mean(light.cells[t[2]].value)) / 3;
        const double share = most > 0 ? std::sqrt(std::max(0.0, value) / most) : 0;
        add_shape(out, drawing, "triangle", {a.u, a.v, b.u, b.v, c.u, c.v}, share_colour(share));
    }
}

/// The strongest units of the kernel network, as lines from their source to their receiver.
void add_rays(const CellLight& light, const std::string& drawing, Table& out) {
    constexpr std::size_t max_rays = 60;
    std::vector<CellLight::Ray> rays = light.kernel;
    std::stable_sort(rays.begin(), rays.end(),
                     [](const auto& a, const auto& b) { return std::abs(mean(a.value)) > std::abs(mean(b.value)); });
    rays.resize(std::min(rays.size(), max_rays));
    for (const CellLight::Ray& ray : rays) {
        const Projected from = project(ray.y), to = project(ray.x);
        add_shape(out, drawing, "line", {from.u, from.v, to.u, to.v}, ray_colour);
        add_shape(out, drawing, "dot", {to.u, to.v}, ray_colour);
    }
}

void add_samples(const std::string& name, const Scene& scene, const std::vector<std::size_t>& units, std::uint64_t seed,
                 Table& out, const StopRequest& stop) {
    constexpr std::size_t samples = 300;
    CsvText text;
    text.print("%s\n", sample_distribution_header);
    write_sample_distribution(name, scene, units, samples, seed, text, stop);
    const Result<Table> drawn = parse_csv(text.text(), "samples");
    if (!drawn) return;
    for (const std::size_t count : units) {
        const std::string drawing = fmt::format("{}, {} units", name, count);
        add_outlines(scene, drawing, out);
        for (std::size_t row = 0; row < drawn->rows.size(); ++row) {
            if (drawn->text(row, "units") != std::to_string(count)) continue;
            const Projected end = project({drawn->number(row, "x"), drawn->number(row, "y"), drawn->number(row, "z")});
            const bool is_near = drawn->text(row, "resampled") == "1";
            add_shape(out, drawing, "dot", {end.u, end.v}, is_near ? ray_colour : uniform_colour);
        }
    }
}

/// Density of centres within a tenth of the step, over the mean density.
double density_at_step(const std::vector<std::array<double, 2>>& centres) {
    constexpr double reach = 0.1;                           // distance from the step; derived from a tenth of the line
    constexpr double area = 1 - (1 - reach) * (1 - reach);  // area of the strip in the unit square
    const auto count =
        std::count_if(centres.begin(), centres.end(), [](const auto& c) { return std::abs(c[0] - c[1]) < reach; });
    return static_cast<double>(count) / static_cast<double>(centres.size()) / area;
}

void add_kernel_values(const std::string& drawing, const std::vector<double>& values, Table& out) {
    constexpr std::size_t side = flatland::GrownKernel::side, step = 2;  // every second value is drawn
    for (std::size_t j = 0; j < side; j += step)
        for (std::size_t i = 0; i < side; i += step) {
            const double x = static_cast<double>(i) / side, y = static_cast<double>(j) / side;
            const double width = static_cast<double>(step) / side;
            add_shape(out, drawing, "box", {x, y, x + width, y + width}, share_colour(values[j * side + i]));
        }
}

}  // namespace

void measure_cell_growth(const std::string& name, const Scene& scene, const std::vector<std::size_t>& units,
                         std::uint64_t seed, CellGrowthTables& out, const StopRequest& stop) {
    for (const auto& [kind, form] :
         {std::pair(CellsKind::classic, "classic"), std::pair(CellsKind::improved, "improved")})
        for (const std::size_t count : units) {
            SolveOptions options{.method = Method::growing_cells, .smoothing = false};
            options.gcs = kind, options.max_units = count, options.seed = seed;
            Progress silent;
            const Stopwatch watch;
            const Result<Solution> solution = solve_scene(scene, options, silent, stop);
            if (!solution || stop.requested()) continue;
            const CellLight& light = cells_of(*solution);
            out.results.add_row();
            out.results.set("scene", name), out.results.set("form", form);
            out.results.set("units", std::to_string(count));
            out.results.set("cells", std::to_string(light.cells.size()));
            out.results.set("rays", std::to_string(light.kernel.size()));
            out.results.set("error", field(solution->statistics.relative_error_estimate.value_or(NAN)));
            out.results.set("seconds", field(watch.seconds()));
            out.results.set("stopped_by", std::string(name_of(solution->statistics.stopped_by)));
            if (kind != CellsKind::classic) continue;
            const std::string drawing = fmt::format("{}, {} units", name, count);
            add_outlines(scene, drawing, out.growth);
            add_triangles(light, drawing, out.growth), add_rays(light, drawing, out.growth);
        }
    add_samples(name, scene, units, seed, out.samples, stop);
}

FlatlandGrowth measure_flatland_growth(const std::vector<std::size_t>& units, std::uint64_t seed) {
    using namespace flatland;
    constexpr double h = 1;  // the largest value of the kernel is 1
    const auto kernel = [](double x, double y) { return x <= y ? 0.0 : 1 / ((x - y) * (x - y) + h * h); };
    FlatlandGrowth out;
    for (const auto& [weights, name] :
         {std::pair(CellWeights::delta_rule, "delta rule"), std::pair(CellWeights::least_squares, "least squares"),
          std::pair(CellWeights::normalised_least_squares, "normalised")}) {
        const auto grown = grow_kernel(kernel, h, units, {.weights = weights, .seed = seed});
        for (std::size_t i = 0; i < units.size(); ++i) {
            out.errors.add_row();
            out.errors.set("weights", name), out.errors.set("units", std::to_string(units[i]));
            out.errors.set("error", field(grown[i].error));
            out.errors.set("near_step", field(density_at_step(grown[i].centres)));
            if (weights != CellWeights::delta_rule) continue;
            const std::string drawing = fmt::format("{} units", units[i]);
            for (std::size_t u = 0; u < grown[i].centres.size(); ++u) {
                const auto [x, y] = grown[i].centres[u];
                add_shape(out.centres, drawing, "circle", {x, y, x + grown[i].widths[u], y}, outline_colour);
                add_shape(out.centres, drawing, "dot", {x, y}, ray_colour);
            }
            add_kernel_values(drawing, grown[i].values, out.approximation);
        }
    }
    std::vector<double> exact;
    for (std::size_t j = 0; j < GrownKernel::side; ++j)
        for (std::size_t i = 0; i < GrownKernel::side; ++i)
            exact.push_back(kernel((static_cast<double>(i) + 0.5) / GrownKernel::side,
                                   (static_cast<double>(j) + 0.5) / GrownKernel::side));
    add_kernel_values("the kernel", exact, out.approximation);
    return out;
}

}  // namespace exitance
