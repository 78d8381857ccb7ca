#include "exitance/lab/cie171/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace exitance {
namespace {

/// Description of a case and the best published result: the largest error unless stated otherwise. Numbers of AGi32
/// (2007), Iray (2016) and Radiance (2008) as quoted in the validation of Blender's Cycles (2026).
struct KnownCase {
    const char *study, *what, *published;
};

constexpr std::array<KnownCase, 10> known_cases{{
    {"5.2", "point source over a plane", "0.1% (Iray); 0.2% (AGi32)"},
    {"5.3", "area source in a ceiling", "about 0 (Iray); 4.9% (Cycles)"},
    {"5.4", "flux of a source through openings", "0.28% (Cycles); 0.31% (AGi32)"},
    {"5.6", "light off a diffuse surface", "0.14% in the mean (Radiance); 0.25% (Cycles)"},
    {"5.7", "the same behind an obstruction", "0.14% in the mean (Radiance); 1.1% (Cycles)"},
    {"5.8", "interreflection in a cube", "0.31% (Cycles); 0.32% in the mean up to 0.8, 26% at 0.95 (Radiance)"},
    {"5.9", "roof opening under sixteen skies", "6.8% (Cycles)"},
    {"5.11", "window under sixteen skies", "17% (Cycles)"},
    {"5.13", "window below a black projection", "12% (Cycles)"},
    {"5.14", "window before a black wall", "5.8% (Cycles)"},
}};

const char* what_is(const std::string& study) {
    for (const KnownCase& known : known_cases)
        if (study == known.study) return known.what;
    return "";
}

const char* published(const std::string& study) {
    for (const KnownCase& known : known_cases)
        if (study == known.study) return known.published;
    return "";
}

std::string percent(double share) {
    constexpr double rounding = 1e-11;
    return share == 0 ? "0" : share < rounding ? "rounding" : fmt::format("{:.2g}%", 100 * share);
}

/// Formats a number with five significant digits, without exponent.
std::string value(double v) {
    return v >= 1000 ? fmt::format("{:.1f}", v) : fmt::format("{:.5g}", v);
}

/// Returns the row with the largest error of each scene.
std::vector<const Cie171Row*> worst_of_scenes(const std::vector<Cie171Row>& rows) {
    std::vector<const Cie171Row*> out;
    for (const Cie171Row& row : rows) {
        const auto at = std::find_if(out.begin(), out.end(), [&](const Cie171Row* known) {
            return known->study == row.study && known->scene == row.scene;
        });
        if (at == out.end())
            out.push_back(&row);
        else if (row.relative_error > (*at)->relative_error)
            *at = &row;
    }
    return out;
}

/// Describes case 5.8 away from the room's edges.
std::string away_from_edges(const std::vector<Cie171Row>& rows) {
    constexpr double min_distance = 0.1;  // metres
    double largest = -1;
    for (const Cie171Row& row : rows)
        if (row.study == "5.8" && std::min(row.x.x, row.x.y) >= min_distance)
            largest = std::max(largest, row.relative_error);
    if (largest < 0) return "";
    return fmt::format(
        "\n5.8 is solved to an RMS error of 1e-4. Its largest errors are 4 mm from an edge, where reflected light "
        "bends most;\n0.1 m and farther from edges the largest error is {}.\n",
        percent(largest));
}

constexpr const char* opening = R"(# Validation: CIE 171

CIE 171:2006 tests single parts of light transport against values that can be computed. `exitance-cie171 FOLDER` (built with the benches) builds the
scenes, solves them like `solve`, evaluates them like `probe`, and writes `results.csv` (a row per value), `summary.csv`, and this page.

Exact values are closed forms (5.2 to 5.7), Gauss quadrature of the skies' formulas over the opening (5.9 to 5.14), and the solution of the integral
equation (5.8; the report's formula for it is the mean over the room, not the value at a point). Some tables of the report contradict their formulas:
table 19 of 5.7, points close to openings in 5.9 and 5.11, and reflecting masks in 5.13 and 5.14. The formula counts there. Cases 5.5, 5.10 and 5.12 are
about glass and have no exact values.

An error is relative to the exact value at the same point, or to the scene's largest value where the exact value is 0. The last column is the largest
error of a point that others have published, unless it says otherwise; much of it is relative to the report's tables, whose own error is up to some
percent close to openings.

## Cases
)";

}  // namespace

std::string cie171_page(const std::vector<Cie171Row>& rows) {
    std::string page = opening;
    page += "| case | subject | values | mean error | largest error | best published |\n|---|---|---|---|---|---|\n";
    for (const Cie171Summary& s : summarize(rows))
        page += fmt::format("| {} | {} | {} | {} | {} | {} |\n", s.study, what_is(s.study), s.points, percent(s.mean),
                            percent(s.largest), published(s.study));
    page += away_from_edges(rows);
    page +=
        "\n## The worst value of every scene\nValues are in lx; fluxes are in lm.\n\n| case | scene | at | exact | "
        "exitance | error "
        "|\n|---|---|---|---|---|---|\n";
    for (const Cie171Row* row : worst_of_scenes(rows))
        page += fmt::format("| {} | {} | {}{}{} | {} | {} | {} |\n", row->study, row->scene, row->parameter,
                            row->parameter.empty() ? "" : ", ", row->point, value(row->exact), value(row->computed),
                            percent(row->relative_error));
    return page;
}

}  // namespace exitance
