#include "exitance/solution.hpp"

#include "exitance/api/inside.hpp"
#include "exitance/io/export/conforming_mesh.hpp"
#include "exitance/io/export/export.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/io/solution/statistics_json.hpp"
#include "exitance/methods/light/mesh_of_layers.hpp"
#include "exitance/what_if/light_groups/keep_light_groups.hpp"

namespace exitance::api {
namespace {

exitance::Component to_engine(Component component) {
    return component == Component::direct     ? exitance::Component::direct
           : component == Component::indirect ? exitance::Component::indirect
                                              : exitance::Component::total;
}

Mesh triangles_of(const exitance::Solution& solution) {
    ConformingMesh conforming = make_conforming(make_element_mesh(solution));
    Mesh out;
    for (const Point& p : conforming.mesh.points) out.vertices.push_back({p.x, p.y, p.z});
    for (std::size_t i = 0; i < conforming.mesh.size(); ++i) {
        const std::uint32_t first = conforming.mesh.first_point[i];
        conforming.for_triangles(i, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            out.triangles.push_back({first + a, first + b, first + c});
            out.face.push_back(conforming.mesh.surface[i]);
        });
    }
    out.irradiance = std::move(conforming.mesh.irradiance), out.radiosity = std::move(conforming.mesh.radiosity);
    return out;
}

}  // namespace

exitance::Result<const exitance::Solution*> SolutionData::meshed() const {
    if (!solution.layers || !solution.discontinuity.empty()) return &solution;
    if (!meshed_solution) {
        auto made = std::make_unique<exitance::Solution>(solution);
        if (const exitance::Result<void> mesh = make_requested_mesh(*made); !mesh) return mesh.error();
        meshed_solution = std::move(made);
    }
    return meshed_solution.get();
}

exitance::Result<const RadiosityFunction*> SolutionData::meshed_light() const {
    const exitance::Result<const exitance::Solution*> made = meshed();
    if (!made) return made.error();
    if (*made == &solution) return &light();
    if (!meshed_function) meshed_function.emplace(**made);
    return &*meshed_function;
}

Result<std::vector<Light>> Solution::light(std::span<const Probe> probes, Component component,
                                           const Control& control) const {
    return take_turn<std::vector<Light>>(control, [&](Run& run) -> Result<std::vector<Light>> {
        const Result<std::vector<ProbePoint>> points = api::to_engine(probes);
        if (!points) return points.error();
        const std::vector<exitance::Light> found = data_->light().at_until(run.stop(), *points, to_engine(component));
        if (found.size() < points->size()) return stopped("the evaluation of light");
        std::vector<Light> out;
        out.reserve(found.size());
        for (const exitance::Light& light : found)
            out.push_back({to_api(light.irradiance), to_api(light.radiosity), light.on_surface});
        return out;
    });
}

std::optional<double> Solution::error() const {
    return data_->solution.statistics.relative_error_estimate;
}

std::optional<double> Solution::error_bound() const {
    return data_->solution.statistics.relative_error_bound;
}

bool Solution::converged() const {
    return data_->solution.statistics.converged;
}

std::string Solution::stopped_by() const {
    return std::string(name_of(data_->solution.statistics.stopped_by));
}

Energy Solution::energy() const {
    const EnergyBalance& e = data_->solution.statistics.energy;
    return {e.emitted, e.absorbed, e.escaped, e.defect};
}

std::vector<std::string> Solution::warnings() const {
    return data_->solution.statistics.warnings;
}

std::string Solution::statistics_json() const {
    return exitance::statistics_json(data_->solution);
}

Scene Solution::scene() const {
    SceneData data;
    data.scene = std::shared_ptr<const exitance::Scene>(data_, &data_->solution.scene);
    data.light_groups = !data_->groups.empty();
    return Scene(std::make_shared<const SceneData>(std::move(data)));
}

Result<Mesh> Solution::mesh() const {
    return take_turn<Mesh>([&]() -> Result<Mesh> {
        const exitance::Result<const exitance::Solution*> meshed = data_->meshed();
        if (!meshed) return to_api(meshed.error());
        return triangles_of(**meshed);
    });
}

Result<void> Solution::export_mesh(const std::string& path) const {
    return take_turn<void>([&]() -> Result<void> {
        const exitance::Result<const exitance::Solution*> meshed = data_->meshed();
        if (!meshed) return to_api(meshed.error());
        return to_api(export_solution(**meshed, path));
    });
}

Result<void> Solution::save(const std::string& path) const {
    if (ending(path) != ".h5" && ending(path) != ".hdf5")
        return usage("a solution is saved as .h5", path,
                     "use render() and Picture.save() for pictures, export() for meshes and tables");
    return take_turn<void>([&] { return to_api(write_solution(path, data_->solution, &data_->groups)); });
}

std::vector<std::string> Solution::light_groups() const {
    std::vector<std::string> out;
    for (const LightGroup& group : data_->groups.groups) out.push_back(group.emitters.name);
    return out;
}

Result<Solution> Solution::mix(const Changes& changes) const {
    return take_turn<Solution>([&]() -> Result<Solution> {
        if (data_->groups.empty())
            return usage("the solution keeps no light groups", "mix", "load the scene with light groups and solve it");
        LightChange change;
        change.dim = changes.dim;
        for (const auto& [name, rho] : changes.reflectance) change.reflectance.emplace_back(name, api::to_engine(rho));
        auto data = std::make_shared<SolutionData>();
        data->solution = data_->solution, data->groups = data_->groups;
        if (const exitance::Result<void> changed = change_light(data->solution, data->groups, change); !changed)
            return to_api(changed.error());
        data->solution.statistics.energy = energy_after_change(data->solution);
        return Solution(std::move(data));
    });
}

Result<Solution> load_solution(const std::string& path) {
    return take_turn<Solution>([&]() -> Result<Solution> {
        auto data = std::make_shared<SolutionData>();
        exitance::Result<exitance::Solution> read = exitance::load_solution(path, Rehearsed::not_yet, &data->groups);
        if (!read) return to_api(read.error());
        data->solution = std::move(*read);
        return Solution(std::move(data));
    });
}

}  // namespace exitance::api
