#include "exitance/lab/studies/cie171.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "exitance/base/parallel.hpp"
#include "exitance/base/quadrature.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/write_error.hpp"
#include "exitance/lab/cie171/cases.hpp"
#include "exitance/lab/cie171/page.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "exitance/scene/locator.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {
namespace {

/// Discards the phases of single cases.
class Quiet : public Progress {};

/// How a case's light is evaluated: like `probe` from a solution; or, if nothing reflects and the sky is an emitter all
/// around, by the same exact direct light without a solution.
using Evaluate = std::function<std::vector<Spectrum>(std::span<const ProbePoint>)>;

Evaluate evaluate_solution(const RadiosityFunction& light) {
    return [&light](std::span<const ProbePoint> points) {
        std::vector<Spectrum> out;
        for (const Light& l : light.at(points)) out.push_back(l.irradiance);
        return out;
    };
}

Evaluate evaluate_direct(const Stage& stage) {
    return [&stage](std::span<const ProbePoint> points) {
        const Locator locator(stage.scene);
        std::vector<Spectrum> out(points.size());
        parallel_for(points.size(), 1, [&](std::size_t i) {
            const SurfaceId s = locator.find(points[i].x, points[i].n);
            const RegionId own = s.is_none() ? RegionId() : stage.scene.surfaces()[s].region;
            DirectLight::Workspace scratch;
            out[i] = stage.direct.irradiance(points[i].x, points[i].n, own, scratch);
        });
        return out;
    };
}

/// Integral of illuminance over a rectangle by Gauss points on cells that are finer near its edges, where light bends
/// in corners.
double flux_of(const Evaluate& light, const Cie171Case::Flux& flux, std::size_t band) {
    constexpr std::array<double, 9> borders{0, 0.002, 0.02, 0.1, 0.5, 0.9, 0.98, 0.998, 1};
    const LineRule rule = gauss_legendre(8);
    std::vector<std::pair<double, double>> line;  // positions and weights of the rule
    for (std::size_t i = 0; i + 1 < borders.size(); ++i)
        for (std::size_t k = 0; k < rule.size(); ++k) {
            const double width = borders[i + 1] - borders[i];
            line.emplace_back(borders[i] + width * rule.nodes[k], width * rule.weights[k]);
        }
    const Vec3 area = cross(flux.u, flux.v);
    std::vector<ProbePoint> points;
    for (const auto& [s, weight] : line)
        for (const auto& [t, other] : line) points.push_back({flux.origin + s * flux.u + t * flux.v, normalized(area)});
    const std::vector<Spectrum> found = light(points);
    double sum = 0;
    for (std::size_t i = 0; i < found.size(); ++i)
        sum += line[i / line.size()].second * line[i % line.size()].second * found[i][band];
    return sum * norm(area);
}

/// Cases that differ only in the band have the same scene.
bool is_same_scene(const Cie171Case& a, const Cie171Case& b) {
    return a.study == "5.8" && b.study == "5.8" && b.band > 0;
}

void add_rows(const Cie171Case& c, const Evaluate& light, std::vector<Cie171Row>& rows) {
    const std::size_t first = rows.size();
    const std::vector<Spectrum> found = light(c.points);
    for (std::size_t i = 0; i < c.points.size(); ++i)
        rows.push_back(
            {c.study, c.scene, c.parameter, c.names[i], c.points[i].x, c.points[i].n, c.exact[i], found[i][c.band]});
    for (const Cie171Case::Flux& flux : c.fluxes)
        rows.push_back(
            {c.study, c.scene, c.parameter, flux.name, flux.origin, {}, flux.exact, flux_of(light, flux, c.band)});
    double largest = 0;
    for (std::size_t i = first; i < first + c.points.size(); ++i) largest = std::max(largest, rows[i].exact);
    for (std::size_t i = first; i < rows.size(); ++i) {
        Cie171Row& row = rows[i];
        row.relative_error = std::abs(row.computed - row.exact) / (row.exact > 0 ? row.exact : largest);
    }
}

}  // namespace

Result<std::vector<Cie171Row>> run_cie171(const Cie171Options& options, Progress& progress, const StopRequest& stop) {
    set_threads(options.threads);
    progress.phase("exact values");
    std::vector<Cie171Case> cases = cie171_lamp_cases(options);
    std::vector<Cie171Case> skies = cie171_sky_cases(options);
    cases.insert(cases.end(), std::make_move_iterator(skies.begin()), std::make_move_iterator(skies.end()));
    if (!options.only.empty()) std::erase_if(cases, [&](const Cie171Case& c) { return c.study != options.only; });
    if (cases.empty())
        return Error{ErrorCode::usage, fmt::format("there is no case '{}' of CIE 171 here", options.only), "",
                     "5.2, 5.3, 5.4, 5.6, 5.7, 5.8, 5.9, 5.11, 5.13, 5.14"};
    progress.phase("solve");
    std::vector<Cie171Row> rows;
    std::optional<Solution> solution;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        Cie171Case& c = cases[i];
        progress.advance(static_cast<double>(i) / static_cast<double>(cases.size()),
                         fmt::format("{} {} {}", c.study, c.scene, c.parameter));
        if (stop.requested()) return Error{ErrorCode::limit, "was stopped before all cases were through", "", ""};
        if (!solution || c.direct_only || !is_same_scene(cases[i - 1], c)) {
            const CheckedScene checked = make_scene(std::move(c.description));
            if (!checked.scene) return checked.scene.error();
            if (c.direct_only) {
                const Stage stage(*checked.scene);
                add_rows(c, evaluate_direct(stage), rows);
                continue;
            }
            c.options.threads = options.threads;
            Quiet quiet;
            Result<Solution> solved = solve_scene(*checked.scene, c.options, quiet, stop);
            if (!solved) return solved.error();
            solution.emplace(std::move(*solved));
        }
        const RadiosityFunction light(*solution);
        add_rows(c, evaluate_solution(light), rows);
    }
    return rows;
}

std::vector<Cie171Summary> summarize(const std::vector<Cie171Row>& rows) {
    std::vector<Cie171Summary> out;
    for (const Cie171Row& row : rows) {
        auto at = std::find_if(out.begin(), out.end(), [&](const Cie171Summary& s) { return s.study == row.study; });
        if (at == out.end()) at = out.insert(out.end(), {row.study, 0, 0, -1, ""});
        ++at->points, at->mean += row.relative_error;
        if (row.relative_error > at->largest) {
            at->largest = row.relative_error;
            at->worst = fmt::format("{}{}{} {}", row.scene, row.parameter.empty() ? "" : " ", row.parameter, row.point);
        }
    }
    for (Cie171Summary& s : out) s.mean /= static_cast<double>(s.points);
    return out;
}

Result<void> write_cie171(const std::string& folder, const std::vector<Cie171Row>& rows) {
    if (const Result<void> made = make_folder(folder); !made) return made.error();
    // A comma in a point's name would start another field.
    const auto quoted = [](const std::string& text) {
        return text.find(',') == std::string::npos ? text : fmt::format("\"{}\"", text);
    };
    std::string table = "study,scene,parameter,point,x,y,z,nx,ny,nz,exact,computed,relative_error\n";
    for (const Cie171Row& r : rows)
        table += fmt::format("{},{},{},{},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.3e}\n",
                             r.study, r.scene, r.parameter, quoted(r.point), r.x.x, r.x.y, r.x.z, r.n.x, r.n.y, r.n.z,
                             r.exact, r.computed, r.relative_error);
    std::string summary = "study,points,mean_relative_error,largest_relative_error,worst\n";
    for (const Cie171Summary& s : summarize(rows))
        summary += fmt::format("{},{},{:.3e},{:.3e},{}\n", s.study, s.points, s.mean, s.largest, quoted(s.worst));
    const std::filesystem::path in(folder);
    if (const Result<void> written = write_file((in / "results.csv").string(), table); !written) return written;
    if (const Result<void> written = write_file((in / "validation.md").string(), cie171_page(rows)); !written)
        return written;
    return write_file((in / "summary.csv").string(), summary);
}

}  // namespace exitance
