#include "exitance/light_maps.hpp"

#include <cmath>
#include <optional>

#include "exitance/api/inside.hpp"
#include "exitance/io/export/light_map_files.hpp"
#include "exitance/io/export/uv_map_files.hpp"
#include "exitance/io/export/uv_target.hpp"
#include "exitance/io/scenes/textures/normal_file.hpp"
#include "exitance/io/scenes/textures/scene_textures.hpp"
#include "exitance/measure/light_maps/light_map.hpp"

namespace exitance::api {

/// Maps in texture coordinates.
struct MapsInUvs {
    UvTarget target;
    UvLightMaps maps;
};

struct LightMapsData {
    Solution solution;
    exitance::LightMaps maps;         ///< Maps of flat parts; empty if the light is in texture coordinates.
    std::optional<MapsInUvs> in_uvs;  ///< Maps in texture coordinates; empty: `maps` has the light.

    const exitance::Scene& scene() const { return solution.data().solution.scene; }
};

namespace {

constexpr int max_padding = 1024;
constexpr int max_texels_along_a_side = 8192;

std::optional<Error> find_wrong_option(const BakeOptions& options) {
    if (!(options.density >= 0) || !std::isfinite(options.density))
        return usage("must be above 0 texels per metre, or 0 for an automatic choice", "density");
    if (options.padding < 1 || options.padding > max_padding) return usage("must be from 1 to 1024 texels", "padding");
    const auto is_size = [](int n) { return n >= 0 && n <= max_texels_along_a_side; };
    if (!is_size(options.width) || !is_size(options.height) || (options.width > 0) != (options.height > 0))
        return usage("must be from 1 to 8192 texels in both directions, or 0 for an automatic choice", "size");
    if (options.width > 0 && options.uv.empty())
        return usage("is the size of maps in texture coordinates", "size", "give uv, or use density");
    return {};
}

Result<MapsInUvs> bake_in_uvs(const Solution& solution, const BakeOptions& options, const CurvedFaces& curved,
                              Run& run) {
    const exitance::Scene& scene = solution.data().solution.scene;
    UvBakeOptions in;
    in.density = options.density, in.padding = options.padding, in.size = {options.width, options.height};
    exitance::Result<UvTarget> target = find_uv_target(scene, find_scene_file(scene, ""), options.uv, in);
    if (!target) return to_api(target.error());
    target->options.curved = &curved;
    const exitance::Result<const RadiosityFunction*> light = solution.data().meshed_light();
    if (!light) return to_api(light.error());
    exitance::Result<UvLightMaps> maps =
        bake_uv_light_maps(**light, target->set, target->options, run.progress(), run.stop());
    if (!maps) return to_api(maps.error());
    target->options.curved = nullptr;
    return MapsInUvs{std::move(*target), std::move(*maps)};
}

}  // namespace

double LightMaps::density() const {
    if (!data_->in_uvs) return data_->maps.density;
    double sum = 0;
    for (const UvLightMap& map : data_->in_uvs->maps.maps) sum += map.density;
    return sum / static_cast<double>(size());
}

std::size_t LightMaps::size() const {
    return data_->in_uvs ? data_->in_uvs->maps.maps.size() : data_->maps.maps.size();
}

LightMap LightMaps::map(std::size_t index) const {
    const exitance::LightMap& map = data_->in_uvs ? data_->in_uvs->maps.maps[index].light : data_->maps.maps[index];
    return {map.size.width, map.size.height, map.irradiance, map.share};
}

std::vector<Chart> LightMaps::charts() const {
    std::vector<Chart> out;
    for (const exitance::Chart& c : data_->maps.charts) {
        Chart chart{c.map, c.x, c.y, c.width, c.height, to_api(c.origin), to_api(c.du), to_api(c.dv), {}};
        for (const SurfaceId s : data_->scene().regions()[c.region].surfaces) chart.faces.push_back(s.value);
        out.push_back(std::move(chart));
    }
    return out;
}

std::vector<std::string> LightMaps::warnings() const {
    if (!data_->in_uvs) return {};
    return chart_warnings(data_->in_uvs->target.set, data_->in_uvs->maps);
}

Result<void> LightMaps::save(const std::string& folder) const {
    return take_turn<void>([&]() -> Result<void> {
        const exitance::Solution& solution = data_->solution.data().solution;
        LightMapFormat format;
        format.scene_file = find_scene_file(solution.scene, "");
        if (!data_->in_uvs) return to_api(write_light_maps(solution, data_->maps, format, {}, folder));
        const auto& [target, maps] = *data_->in_uvs;
        const exitance::Result<void> written = write_uv_pictures(solution.scene, maps, {}, format, folder);
        if (!written) return to_api(written);
        return to_api(write_uv_model(solution, target, maps, format, {}, {}, folder));
    });
}

Result<LightMaps> bake(const Solution& solution, const BakeOptions& options, const Control& control) {
    return take_turn<LightMaps>(control, [&](Run& run) -> Result<LightMaps> {
        if (const std::optional<Error> wrong = find_wrong_option(options)) return *wrong;
        const exitance::Scene& scene = solution.data().solution.scene;
        const CurvedFaces curved =
            options.faceted ? CurvedFaces() : CurvedFaces(scene, load_normals(scene, find_scene_file(scene, "")));
        auto data = std::make_shared<LightMapsData>(LightMapsData{solution, {}, {}});
        if (options.uv.empty()) {
            exitance::BakeOptions in;
            in.density = options.density, in.padding = options.padding, in.curved = &curved;
            const exitance::Result<const RadiosityFunction*> light = solution.data().meshed_light();
            if (!light) return to_api(light.error());
            exitance::Result<exitance::LightMaps> maps = bake_light_maps(**light, in, run.progress(), run.stop());
            if (!maps) return to_api(maps.error());
            data->maps = std::move(*maps);
        } else {
            Result<MapsInUvs> maps = bake_in_uvs(solution, options, curved, run);
            if (!maps) return maps.error();
            data->in_uvs = std::move(*maps);
        }
        if (run.stop().requested()) return stopped("baking");
        return LightMaps(std::move(data));
    });
}

}  // namespace exitance::api
