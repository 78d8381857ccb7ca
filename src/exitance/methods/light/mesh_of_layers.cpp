#include "exitance/methods/light/mesh_of_layers.hpp"

#include <fmt/format.h>

#include <charconv>
#include <sstream>

#include "exitance/methods/light/discontinuity_light.hpp"
#include "exitance/methods/options/solve_option_table.hpp"
#include "exitance/methods/plan/plan.hpp"
#include "exitance/solution/layers/light_layers.hpp"

namespace exitance {
namespace {

constexpr std::string_view error_name = "--error-interpolant", seed_name = "--seed", lines_name = "--dm-lines",
                           surface_name = "surface";

/// True for the options of discontinuity meshing that a single mesh has.
bool is_of_mesh(const OptionRow& row) {
    return row.section == "discontinuity" && row.name != "--layers";
}

template <class T>
bool read_number(std::string_view word, T& value) {
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && end == word.data() + word.size();
}

/// Reads one option. Returns false if it is none of a mesh.
bool read_option(const std::string& name, const std::string& word, SolveRequest& request) {
    SolveOptions& options = request.options;
    if (name == seed_name) return read_number(word, options.seed);
    if (name == error_name)
        return read_number(word, options.error_interpolant.emplace()) && *options.error_interpolant > 0;
    if (name == surface_name) {
        std::optional<ShadowLines>& lines = options.discontinuity.lines;
        if (!lines) lines.emplace().kind = ShadowLines::Kind::on_surfaces;
        lines->names.push_back(word);
        return true;
    }
    const OptionRow* const row = find_option(name);
    return row && is_of_mesh(*row) && row->value.read(word, request).empty();
}

}  // namespace

std::string describe_mesh(const SolveOptions& options) {
    const double error = options.error_interpolant.value_or(options.error_target());
    std::string out = fmt::format("{} {}\n{} {}\n", error_name, error, seed_name, options.seed);
    const SolveRequest request{.options = options};
    for (const OptionRow& row : solve_option_table()) {
        if (!is_of_mesh(row)) continue;
        const std::optional<std::string> word = row.value.word(request);
        const auto& lines = options.discontinuity.lines;
        if (row.name == lines_name && lines && lines->kind == ShadowLines::Kind::on_surfaces)
            for (const std::string& name : lines->names) out += fmt::format("{} {}\n", surface_name, name);
        else if (word)
            out += fmt::format("{} {}\n", row.name, *word);
    }
    return out;
}

Result<SolveOptions> read_mesh_options(const std::string& text) {
    SolveRequest request;
    request.options.method = Method::discontinuity;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t blank = std::min(line.find(' '), line.size());
        const std::string word = blank < line.size() ? line.substr(blank + 1) : std::string();
        if (!read_option(line.substr(0, blank), word, request))
            return Error{ErrorCode::bad_input, fmt::format("'{}' is no option of a mesh", line), "", ""};
    }
    return request.options;
}

Result<void> make_requested_mesh(Solution& solution, const StopRequest& stop) {
    if (!solution.layers || !solution.discontinuity.empty()) return {};
    const std::string& text = layers_of(solution).mesh;
    if (text.empty())
        return Error{ErrorCode::usage, "the layers do not record the options of a single mesh", "",
                     "solve again without --layers on"};
    Result<SolveOptions> options = read_mesh_options(text);
    if (!options) return options.error();
    if (const Result<void> linked = check_extensions(*options); !linked) return linked.error();
    options->bounces = solution.bounces;
    Stage stage(solution.scene);
    survey(stage, *options, stop);
    SixNodeMesh mesh = single_discontinuity_mesh(stage, *options, solution, stop);
    if (stop.requested() || mesh.empty())
        return Error{ErrorCode::limit, "was stopped before the mesh of the layers was made", "", ""};
    solution.discontinuity = std::move(mesh);
    solution.interpolant = linear_elements(solution.discontinuity, solution.scene);
    return {};
}

}  // namespace exitance
