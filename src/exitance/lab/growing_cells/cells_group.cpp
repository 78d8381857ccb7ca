#include "exitance/lab/growing_cells/cells_group.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

void add(std::vector<double>& out, const Vec3& v) {
    out.insert(out.end(), {v.x, v.y, v.z});
}
void add(std::vector<double>& out, const Spectrum& s) {
    out.insert(out.end(), s.value.begin(), s.value.end());
}
Vec3 vector_at(const std::vector<double>& in, std::size_t i) {
    return {in[3 * i], in[3 * i + 1], in[3 * i + 2]};
}
Spectrum spectrum_at(const std::vector<double>& in, std::size_t i) {
    Spectrum out;
    std::copy_n(&in[bands * i], bands, out.value.begin());
    return out;
}

bool is_sound(const std::vector<double>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double v) { return std::isfinite(v); });
}
template <std::size_t corners>
std::vector<std::uint32_t> flat_corners(const std::vector<std::array<std::uint32_t, corners>>& simplices) {
    std::vector<std::uint32_t> out;
    for (const auto& s : simplices) out.insert(out.end(), s.begin(), s.end());
    return out;
}
template <std::size_t corners>
std::vector<std::array<std::uint32_t, corners>> read_corners(Hdf5Reader& file, const std::string& name,
                                                             std::size_t unit_count) {
    const auto flat = file.read<std::uint32_t>(name, corners);
    std::vector<std::array<std::uint32_t, corners>> out(file.failed() ? 0 : flat.size() / corners);
    for (std::size_t i = 0; i < out.size() * corners; ++i) {
        if (flat[i] >= unit_count) return file.fail(name, "refers to a unit that does not exist"), decltype(out)();
        out[i / corners][i % corners] = flat[i];
    }
    return out;
}

}  // namespace

void write_cells(Hdf5Writer& file, const std::string& group, const Solution& solution) {
    const CellLight& light = cells_of(solution);
    if (light.cells.empty()) return;
    std::vector<double> centre, normal, width, value, slope, ray_x, ray_y, ray_width, ray_value;
    for (const CellLight::Cell& c : light.cells) {
        add(centre, c.at), add(normal, c.n), add(value, c.value);
        width.push_back(c.width);
        for (const Spectrum& s : c.slope) add(slope, s);
    }
    for (const CellLight::Ray& r : light.kernel) {
        add(ray_x, r.x), add(ray_y, r.y), add(ray_value, r.value);
        ray_width.push_back(r.width);
    }
    const auto in = [&](const char* name) { return group + "/" + name; };
    file.make_group(group);
    file.set_attribute(group, "delivered", static_cast<std::int64_t>(solution.delivers_own_form));
    file.set_attribute(group, "normalised", static_cast<std::int64_t>(light.normalised));
    file.write(in("centre"), centre, 3, {"m", "units of the shading network"});
    file.write(in("normal"), normal, 3, {"1", "which way a unit's surface faces"});
    file.write(in("width"), width, 1, {"m", "d of a unit's Gaussian exp(-r^2 / d^2)"});
    file.write(in("value"), value, bands, {"W/m^2", "irradiance that a unit holds"});
    file.write(in("slope"), slope, 3 * bands, {"W/m^3", "how it changes along x, y, z, a value a band"});
    file.write(in("triangles"), flat_corners(light.triangles), 3, {"1", "of the shading network: three units"});
    file.write(in("ray_x"), ray_x, 3, {"m", "units of the kernel network: where light arrives"});
    file.write(in("ray_y"), ray_y, 3, {"m", "where it comes from"});
    file.write(in("ray_width"), ray_width, 1, {"m", "width of such a unit"});
    file.write(in("ray_value"), ray_value, bands, {"1", "its output: W/m^4, or visibility"});
    file.write(in("ray_edges"), flat_corners(light.kernel_edges), 2, {"1", "edges of the kernel network: two units"});
}

void read_cells(Hdf5Reader& file, const std::string& group, Solution& solution) {
    const auto in = [&](const char* name) { return group + "/" + name; };
    CellLight light;
    const bool delivered = file.integer_attribute(group, "delivered").value_or(0) != 0;
    light.normalised = file.integer_attribute(group, "normalised").value_or(1) != 0;
    const auto centre = file.read<double>(in("centre"), 3);
    const std::size_t cells = centre.size() / 3;
    const auto normal = file.read<double>(in("normal"), 3, cells);
    const auto width = file.read<double>(in("width"), 1, cells);
    const auto value = file.read<double>(in("value"), bands, cells);
    const auto slope = file.read<double>(in("slope"), 3 * bands, cells);
    const auto ray_x = file.read<double>(in("ray_x"), 3);
    const std::size_t rays = ray_x.size() / 3;
    const auto ray_y = file.read<double>(in("ray_y"), 3, rays);
    const auto ray_width = file.read<double>(in("ray_width"), 1, rays);
    const auto ray_value = file.read<double>(in("ray_value"), bands, rays);
    light.triangles = read_corners<3>(file, in("triangles"), cells);
    light.kernel_edges = read_corners<2>(file, in("ray_edges"), rays);
    if (file.failed()) return;
    for (const auto* numbers : {&centre, &normal, &width, &value, &slope, &ray_x, &ray_y, &ray_width, &ray_value})
        if (!is_sound(*numbers)) return file.fail(group, "holds a number that is not finite");
    if (!std::all_of(width.begin(), width.end(), [](double w) { return w > 0; }))
        return file.fail(in("width"), "holds a width that is not above 0");
    for (std::size_t i = 0; i < cells; ++i)
        light.cells.push_back(
            {vector_at(centre, i),
             vector_at(normal, i),
             width[i],
             spectrum_at(value, i),
             {spectrum_at(slope, 3 * i), spectrum_at(slope, 3 * i + 1), spectrum_at(slope, 3 * i + 2)}});
    for (std::size_t i = 0; i < rays; ++i)
        light.kernel.push_back({vector_at(ray_x, i), vector_at(ray_y, i), ray_width[i], spectrum_at(ray_value, i)});
    solution.delivers_own_form = delivered && !light.cells.empty();
    solution.own_form = std::make_shared<CellsForm>(std::move(light));
}

}  // namespace exitance
