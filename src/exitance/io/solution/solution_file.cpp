#include "exitance/io/solution/solution_file.hpp"

#include "exitance/base/version.hpp"
#include "exitance/discontinuity/discontinuity_mesh.hpp"
#include "exitance/evaluate/layer_elements.hpp"
#include "exitance/io/solution/solution_groups.hpp"
#include "exitance/io/solution/stored_scene_check.hpp"

namespace exitance {
namespace {

/// Format numbers. In format 2, `interpolant` may be left out. Since format 3, points that corners share are stored
/// once (`vertex`, `root_corner`).
constexpr std::int64_t first_format = 1, format = 3;

std::vector<LightFormGroup>& known_groups() {
    static std::vector<LightFormGroup> groups{{"layers", write_layers, read_layers}};
    return groups;
}

/// True if the exported elements are those of the discontinuity mesh, so that they need not be stored.
bool follows_from_mesh(const Solution& solution) {
    if (solution.discontinuity.empty()) return false;
    const ElementFunction found = linear_elements(solution.discontinuity, solution.scene);
    return found.tree.size() == solution.interpolant.tree.size() && found.values == solution.interpolant.values;
}

/// True if the exported elements follow from the layers. Those of light groups do not, since they are sums over groups.
bool follows_from_layers(const Solution& solution, const LightGroups* groups) {
    return solution.layers && solution.discontinuity.empty() && (!groups || groups->empty());
}

}  // namespace

void add_light_form_group(const LightFormGroup& group) {
    for (const LightFormGroup& known : known_groups())
        if (std::string_view(known.name) == group.name) return;
    known_groups().push_back(group);
}

std::span<const LightFormGroup> light_form_groups() {
    return known_groups();
}

Result<void> write_solution(const std::string& path, const Solution& solution, const LightGroups* groups,
                            VtkGroup vtk) {
    Hdf5Writer file(path);
    if (solution.scene.is_photometric()) file.use_lumens();
    const bool is_of_layers = follows_from_layers(solution, groups);
    if (is_of_layers) file.pack_tightly();
    if (vtk == VtkGroup::written && !is_of_layers) write_vtkhdf(file, solution);
    file.make_group("exitance");
    const bool omits_interpolant = is_of_layers || follows_from_mesh(solution);
    file.set_attribute("exitance", "format", format);
    file.set_attribute("exitance", "program_version", std::string_view(program_version));
    file.set_attribute("exitance", "bands", static_cast<std::int64_t>(bands));
    file.set_attribute("exitance", "bounces", static_cast<std::int64_t>(solution.bounces));
    file.set_attribute("exitance", "direct_in_elements", static_cast<std::int64_t>(solution.direct_in_elements));
    file.write_text("exitance/options", solution.options, {"1", "options in force, as JSON"});
    StoredScene::write(file, "exitance/scene", solution.scene);
    const Field<RegionId, Region>& regions = solution.scene.regions();
    write_function(file, "exitance/indirect", solution.indirect, regions);
    const Spectrum& c = solution.direct_share;
    file.write("exitance/direct_share", std::span<const double>(c.value), 1,
               {"1", "share of the direct light that the values of indirect hold too, a value a band"});
    if (!omits_interpolant)
        write_function(file, "exitance/interpolant", solution.interpolant, regions,
                       WrittenTree{"exitance/indirect", solution.indirect.tree});
    if (!solution.discontinuity.empty()) write_discontinuity(file, "exitance/discontinuity", solution.discontinuity);
    for (const LightFormGroup& form : light_form_groups())
        form.write(file, std::string("exitance/") + form.name, solution);
    if (!solution.links.links.empty()) write_links(file, "exitance/links", solution.links, regions);
    if (groups && !groups->empty()) write_light_groups(file, "exitance/groups", *groups);
    write_statistics(file, "exitance/statistics", solution.statistics, own_unit(solution.scene.is_photometric()));
    return file.commit();
}

Result<Solution> load_solution(const std::string& path, Rehearsed rehearsed, LightGroups* groups) {
    Result<Hdf5Reader> opened = Hdf5Reader::open(path, rehearsed);
    if (!opened) return opened.error();
    Hdf5Reader& file = *opened;
    const auto wrong = [&](const std::string& what) {
        return Error{ErrorCode::bad_input, what, path, "solve the scene again with this program"};
    };
    const auto found = file.integer_attribute("exitance", "format");
    if (!found) return wrong("is an HDF5 file, but no solution of exitance");
    if (*found < first_format || *found > format)
        return wrong("is of format " + std::to_string(*found) + "; this program reads formats " +
                     std::to_string(first_format) + " to " + std::to_string(format));
    const std::int64_t held = file.integer_attribute("exitance", "bands").value_or(0);
    if (held != static_cast<std::int64_t>(bands))
        return wrong("has " + std::to_string(held) + " bands; this program carries " + std::to_string(bands));

    Solution solution;
    solution.bounces = static_cast<int>(file.integer_attribute("exitance", "bounces").value_or(-1));
    solution.direct_in_elements = file.integer_attribute("exitance", "direct_in_elements").value_or(0) != 0;
    solution.options = file.read_text("exitance/options");
    solution.scene = StoredScene::read(file, "exitance/scene");
    const Field<RegionId, Region>& regions = solution.scene.regions();
    solution.indirect = read_function(file, "exitance/indirect", regions);
    if (file.has("exitance/direct_share")) {
        const std::vector<double> c = file.read<double>("exitance/direct_share", 1, bands);
        std::copy(c.begin(), c.end(), solution.direct_share.value.begin());
        if (!is_finite(solution.direct_share)) file.fail("exitance/direct_share", "holds a number that is not finite");
    }
    if (file.has("exitance/discontinuity"))
        solution.discontinuity = read_discontinuity(file, "exitance/discontinuity", regions.size());
    for (const LightFormGroup& form : light_form_groups())
        if (const std::string group = std::string("exitance/") + form.name; file.has(group))
            form.read(file, group, solution);
    solution.statistics = read_statistics(file, "exitance/statistics");
    const bool is_of_layers = solution.layers && solution.discontinuity.empty();
    if (file.has("exitance/interpolant") || (solution.discontinuity.empty() && !is_of_layers))
        solution.interpolant = read_function(file, "exitance/interpolant", regions);
    else if (!file.failed() && !is_of_layers)
        solution.interpolant = linear_elements(solution.discontinuity, solution.scene);
    if (file.has("exitance/links")) solution.links = read_links(file, "exitance/links", regions);
    if (groups && file.has("exitance/groups") && !file.failed())
        *groups = read_light_groups(file, "exitance/groups", solution);
    if (file.failed()) return file.error();
    for (const ElementTree* tree : {&solution.indirect.tree, &solution.interpolant.tree})
        if (const auto nonsense = find_nonsense(*tree, solution.scene)) return wrong("is damaged: " + *nonsense);
    if (is_of_layers && solution.interpolant.tree.size() == 0) solution.interpolant = elements_of_layers(solution);
    return solution;
}

}  // namespace exitance
