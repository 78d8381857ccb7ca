#include "exitance/lab/classical/classical.hpp"

#include "exitance/base/parallel.hpp"

namespace exitance {

GlobalLight published_light(const MethodInput& input) {
    GlobalLight light;
    light.delivery = carries_light(input) ? MethodDelivery::all_light : MethodDelivery::apart;
    light.published.emplace();
    light.published->figures["initial_links"] = 0;
    return light;
}

ElementTree constant_mesh(const Stage& stage, const SolveOptions& options, const Knobs& knobs,
                          const StopRequest& stop) {
    const MeshSize size = knobs.solve_mesh;
    if (options.classical.mesh == MeshKind::uniform) return make_mesh(stage.pieces, stage.concave, {.edge = size.edge});
    return project_direct_light(stage, {.mesh = size, .tolerance = knobs.direct_tolerance}, stop).tree;
}

std::vector<Spectrum> mean_direct_light(const MethodInput& input, const ElementTree& tree,
                                        std::span<const ElementId> leaves) {
    std::vector<Spectrum> out(leaves.size());
    parallel_ranges(leaves.size(), 16, [&](std::size_t first, std::size_t last) {
        DirectFitRoom room;
        for (std::size_t i = first; i < last; ++i)
            out[i] = fit_direct_light(input.stage, tree, leaves[i], 0, room).mean;
    });
    return out;
}

std::vector<Spectrum> exitances(const MethodInput& input, const ElementTree& tree, std::span<const ElementId> leaves) {
    std::vector<Spectrum> out;
    for (ElementId e : leaves) out.push_back(material_of(input, tree, e).exitance);
    return out;
}

ElementFunction constant_function(const ElementTree& tree, std::span<const ElementId> leaves,
                                  std::span<const Spectrum> values) {
    ElementFunction out;
    out.tree = tree;
    out.first_value.resize(tree.size(), 0);
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        out.first_value[leaves[i]] = static_cast<std::uint32_t>(out.values.size());
        for (int corner = 0; corner < 4; ++corner) out.add_value(values[i]);
    }
    return out;
}

}  // namespace exitance
