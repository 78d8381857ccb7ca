#include "exitance/cli/verbs/factor_output.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/view_factors/thermal_table.hpp"

namespace exitance {
namespace {

Error usage(const char* option, const std::string& what, const std::string& hint) {
    return {ErrorCode::usage, what, option, hint};
}

/// Names of the formats for which `is_meant` is true.
std::string names_of_formats(bool (*is_meant)(const FactorFormatTraits&)) {
    std::vector<std::string_view> names;
    for (const FactorFormatTraits& traits : factor_formats)
        if (is_meant(traits)) names.push_back(traits.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

/// Adds script F and Gebhart's factors of all rows. Rows that do not add up to 1 see surroundings at 0 K.
Result<void> add_exchange_factors(const ViewFactorArguments& arguments, const SparseFactors& table,
                                  FactorFileOptions& options, const StopRequest& stop) {
    Result<std::vector<ThermalSurface>> surfaces =
        arguments.emissivity == "kd" ? emissivities_of(table) : read_thermal_table(arguments.emissivity, table);
    if (!surfaces) return surfaces.error();
    // Exchange factors need surfaces of given temperature; the value of the temperature has no effect.
    for (ThermalSurface& surface : *surfaces) surface.temperature = 1, surface.heat = 0;
    const std::optional<double> surroundings = is_enclosure(table) ? std::nullopt : std::optional(0.0);
    const auto exchange = exchange_factors(table, *surfaces, surroundings, stop);
    if (!exchange) return exchange.error();
    for (std::size_t i = 0; i < exchange->size(); ++i)
        for (const double f : (*exchange)[i])
            options.script_f.push_back(f), options.gebhart.push_back(f / (*surfaces)[i].emissivity);
    return {};
}

}  // namespace

FactorFormat format_of(const ViewFactorArguments& arguments) {
    return arguments.format.value_or(factor_format_of(arguments.output));
}

Result<void> check_output_options(const ViewFactorArguments& arguments) {
    const FactorFormat format = format_of(arguments);
    const std::string& transport = arguments.operator_file;
    if (!transport.empty() && ending(transport) != ".h5")
        return usage("--operator", "must end in .h5", "use --operator FILE.h5");
    if (!transport.empty() && transport == arguments.output)
        return usage("--operator", "is also the file of --output", "choose another name");
    if (arguments.output.empty() && (!arguments.nodes.empty() || arguments.with_sky))
        return usage(arguments.with_sky ? "--sky" : "--nodes", "applies to the matrix of --output only",
                     "add -o FILE, or leave it out");
    if (arguments.with_sky && format == FactorFormat::hdf5)
        return usage("--sky", "is not needed for .h5: it always has the shares of the sky and of backs",
                     "leave it out");
    if (arguments.with_sky && !traits_of(format).takes_sky)
        return usage("--sky", "the output's format has no columns for the sky",
                     "formats that have them: " + names_of_formats([](const auto& f) { return f.takes_sky; }));
    if (arguments.with_sky && arguments.tolerance)
        return usage("--sky", "cannot be combined with --tolerance, which does not compute the sky", "use --error");
    if (!arguments.zone.empty() && format != FactorFormat::energyplus)
        return usage("--zone", "applies to --format energyplus only", "leave it out");
    if (!arguments.emissivity.empty() && format != FactorFormat::hdf5)
        return usage("--emissivity", "the output's format has no exchange factors", "use -o FILE.h5");
    return {};
}

Result<std::optional<FactorNodes>> nodes_of(const ViewFactorArguments& arguments, const Scene& scene) {
    const bool is_view3d = ending(arguments.scene.files.front()) == ".vs3";
    if (is_view3d && arguments.nodes == "material")
        return usage("--nodes", "material does not apply to .vs3 files, which have no materials",
                     "use group or a table");
    // The groups of a .vs3 file are the rows of View3D's result, and one of surfaces that only block.
    if (is_view3d && (arguments.nodes.empty() || arguments.nodes == "group"))
        return std::optional(view3d_rows(scene, arguments.scene.files.front()));
    if (arguments.nodes.empty()) return std::optional<FactorNodes>();
    if (arguments.nodes == "group") return std::optional(nodes_by_group(scene));
    if (arguments.nodes == "material") return std::optional(nodes_by_material(scene));
    Result<FactorNodes> table = read_node_table(arguments.nodes, scene.surfaces().size());
    if (!table) return table.error();
    return std::optional(std::move(*table));
}

Result<void> check_emissivities(const ViewFactorArguments& arguments, const Scene& scene,
                                const std::optional<FactorNodes>& nodes) {
    if (arguments.emissivity.empty() || arguments.emissivity == "kd") return {};
    SparseFactors rows;  // only the number of rows and their names are used
    rows.areas.assign(nodes ? nodes->names.size() : scene.surfaces().size(), 1);
    if (nodes) rows.names = nodes->names;
    const auto surfaces = read_thermal_table(arguments.emissivity, rows);
    return surfaces ? Result<void>() : surfaces.error();
}

Result<void> write_factor_output(const ViewFactorArguments& arguments, const Scene& scene, const Point& scene_origin,
                                 const std::optional<FactorNodes>& nodes, SparseFactors table,
                                 const StopRequest& stop) {
    FactorFileOptions options;
    options.format = format_of(arguments), options.with_sky = arguments.with_sky, options.origin = scene_origin;
    if (!arguments.zone.empty()) options.zone = arguments.zone;
    if (nodes) {
        table = merge_nodes(table, *nodes);
        for (const std::uint32_t row : nodes->row_of_face)
            options.row_of_face.push_back(row == no_row ? -1 : static_cast<std::int32_t>(row));
    } else if (*options.format == FactorFormat::energyplus) {
        table.names = face_names(scene);
    }
    const bool is_whole = std::find(table.finished.begin(), table.finished.end(), 0) == table.finished.end();
    if (!arguments.emissivity.empty() && is_whole)
        if (const Result<void> added = add_exchange_factors(arguments, table, options, stop); !added) return added;
    return write_view_factors(arguments.output, table, stop, options);
}

}  // namespace exitance
