#include <algorithm>
#include <cmath>
#include <sstream>

#include "exitance/io/solution/solution_file.hpp"
#include "exitance/io/solution/solution_groups.hpp"

namespace exitance {
namespace {

std::vector<float> flat(const std::vector<LightGroup>& groups, CornerValues LightGroup::*values) {
    std::vector<float> out;
    for (const LightGroup& g : groups)
        for (const auto& v : g.*values) out.insert(out.end(), v.begin(), v.end());
    return out;
}

std::vector<double> flat(const std::vector<Spectrum>& values) {
    std::vector<double> out;
    for (const Spectrum& v : values) out.insert(out.end(), v.value.begin(), v.value.end());
    return out;
}

bool is_light(float v) {
    return std::isfinite(v);
}

CornerValues part_of(const std::vector<float>& all, std::size_t part, std::size_t count) {
    CornerValues out(count);
    for (std::size_t i = 0; i < count; ++i) std::copy_n(&all[(part * count + i) * bands], bands, out[i].begin());
    return out;
}

std::vector<Spectrum> spectra(Hdf5Reader& file, const std::string& name, std::size_t count) {
    const auto numbers = file.read<double>(name, bands, count);
    std::vector<Spectrum> out(count);
    if (file.failed()) return out;
    for (std::size_t i = 0; i < count * bands; ++i) {
        if (!std::isfinite(numbers[i]) || numbers[i] < 0) return file.fail(name, "holds a number below 0"), out;
        out[i / bands][i % bands] = numbers[i];
    }
    return out;
}

/// Reads the emitters of each group, as pairs of group and index.
void read_emitters(Hdf5Reader& file, const std::string& group, const Scene& scene, LightGroups& out) {
    const auto materials = file.read<std::uint32_t>(group + "/materials", 2);
    const auto lights = file.read<std::uint32_t>(group + "/lights", 2);
    const auto distant = file.read<std::uint32_t>(group + "/distant_groups", 1);
    const std::size_t count = out.groups.size();
    for (std::size_t i = 0; i + 1 < materials.size(); i += 2) {
        if (materials[i] >= count || materials[i + 1] >= scene.materials().size())
            return file.fail(group + "/materials", "refers to an index that does not exist");
        out.groups[materials[i]].emitters.materials.push_back(MaterialId(materials[i + 1]));
    }
    for (std::size_t i = 0; i + 1 < lights.size(); i += 2) {
        if (lights[i] >= count || lights[i + 1] >= scene.lights().size())
            return file.fail(group + "/lights", "refers to an index that does not exist");
        out.groups[lights[i]].emitters.lights.push_back(lights[i + 1]);
    }
    for (const std::uint32_t g : distant) {
        if (g >= count) return file.fail(group + "/distant_groups", "refers to an index that does not exist");
        out.groups[g].emitters.is_distant = true;
    }
}

/// Reads the light of all groups at `corners` corners.
void read_values(Hdf5Reader& file, const std::string& name, std::size_t corners, std::vector<LightGroup>& groups,
                 CornerValues LightGroup::*values) {
    const auto all = file.read<float>(name, bands, groups.size() * corners);
    if (file.failed()) return;
    if (!std::all_of(all.begin(), all.end(), is_light)) return file.fail(name, "holds a number that is not finite");
    for (std::size_t g = 0; g < groups.size(); ++g) groups[g].*values = part_of(all, g, corners);
}

/// Reads element ids of a tree with `count` elements, in any order.
std::vector<std::uint32_t> read_elements(Hdf5Reader& file, const std::string& name, std::size_t count) {
    std::vector<std::uint32_t> out = file.read<std::uint32_t>(name, 1);
    for (const std::uint32_t e : out)
        if (e >= count) return file.fail(name, "refers to an index that does not exist"), std::vector<std::uint32_t>();
    return out;
}

void read_transport(Hdf5Reader& file, const std::string& group, const Solution& solution, KeptTransport& out) {
    const auto in = [&](const char* name) { return group + "/transport_" + name; };
    out.receiver = read_elements(file, in("receiver"), solution.indirect.tree.size());
    out.source = read_elements(file, in("source"), solution.interpolant.tree.size());
    if (file.failed() || out.source.empty()) return;
    out.first = file.read<std::uint32_t>(in("first"), 1, out.receiver.size() + 1);
    const auto weight = file.read<float>(in("weight"), 4, out.source.size());
    if (file.failed()) return;
    if (out.first.front() != 0 || out.first.back() != out.source.size() ||
        !std::is_sorted(out.first.begin(), out.first.end()))
        return file.fail(in("first"), "are not valid rows");
    if (!std::all_of(weight.begin(), weight.end(), is_light))
        return file.fail(in("weight"), "holds a number that is not finite");
    out.weight.resize(out.source.size());
    for (std::size_t i = 0; i < weight.size(); ++i) out.weight[i / 4][i % 4] = weight[i];
    out.rays = static_cast<std::size_t>(std::max<std::int64_t>(0, file.integer_attribute(group, "rays").value_or(0)));
    const auto error = file.read<double>(in("error"), 1, 1);
    if (!file.failed() && std::isfinite(error[0])) out.error = error[0];
}

/// Reads the values that belong to each group alone.
void read_facts(Hdf5Reader& file, const std::string& group, std::vector<LightGroup>& groups) {
    const auto factor = file.read<double>(group + "/factor", 1, groups.size());
    const auto error = file.read<double>(group + "/error", 1, groups.size());
    const auto reflected = file.read<double>(group + "/reflected", 1, groups.size());
    for (std::size_t g = 0; g < groups.size() && !file.failed(); ++g) {
        if (!(factor[g] >= 0) || !std::isfinite(factor[g]) || !std::isfinite(reflected[g]))
            return file.fail(group + "/factor", "is not a dimming factor of at least 0");
        groups[g].factor = factor[g], groups[g].reflected = reflected[g];
        if (std::isfinite(error[g])) groups[g].error = error[g];
    }
}

void write_transport(Hdf5Writer& file, const std::string& group, const KeptTransport& transport) {
    const auto in = [&](const char* name) { return group + "/transport_" + name; };
    std::vector<float> weight;
    for (const auto& w : transport.weight) weight.insert(weight.end(), w.begin(), w.end());
    file.write(in("receiver"), transport.receiver, 1, {"1", "elements of indirect that light is gathered on"});
    file.write(in("first"), transport.first, 1, {"1", "where the row of each begins, and one past the last"});
    file.write(in("source"), transport.source, 1, {"1", "elements of interpolant"});
    file.write(in("weight"), weight, 4, {"1", "what light of each brings to the corners of the receiver's patch"});
    file.write(in("error"), std::vector<double>{transport.error}, 1,
               {"1", "RMS of what it brings of the light of all groups against indirect"});
}

}  // namespace

void write_light_groups(Hdf5Writer& file, const std::string& group, const LightGroups& groups) {
    const auto in = [&](const char* name) { return group + "/" + name; };
    std::string names;
    std::vector<double> factor, error, reflected;
    std::vector<std::uint32_t> materials, lights, distant;  // pairs of group and index
    for (std::uint32_t g = 0; g < groups.groups.size(); ++g) {
        const LightGroup& one = groups.groups[g];
        std::string name = one.emitters.name;
        std::replace(name.begin(), name.end(), '\n', ' ');
        names += name + "\n";
        factor.push_back(one.factor), reflected.push_back(one.reflected);
        error.push_back(one.error.value_or(std::nan("")));
        for (const MaterialId m : one.emitters.materials) materials.insert(materials.end(), {g, m.value});
        for (const std::uint32_t l : one.emitters.lights) lights.insert(lights.end(), {g, l});
        if (one.emitters.is_distant) distant.push_back(g);
    }
    file.make_group(group);
    file.set_attribute(group, "rays", static_cast<std::int64_t>(groups.transport.rays));
    file.write_text(in("names"), names, {"1", "light that is switched together, a line each"});
    file.write(in("factor"), factor, 1, {"1", "by which each is dimmed here"});
    file.write(in("error"), error, 1, {"1", "estimated with it alone; NaN: not known"});
    file.write(in("reflected"), reflected, 1, {"W/m^2", "mean light that surfaces reflect with it alone"});
    file.write(in("materials"), materials, 2, {"1", "group, and a material that emits in it"});
    file.write(in("lights"), lights, 2, {"1", "group, and a light without extent"});
    file.write(in("distant_groups"), distant, 1, {"1", "the group of all distant light"});
    file.write(in("indirect"), flat(groups.groups, &LightGroup::indirect), bands,
               {"W/m^2", "values of indirect, group by group, undimmed"});
    file.write(in("interpolant"), flat(groups.groups, &LightGroup::interpolant), bands,
               {"W/m^2", "values of interpolant, likewise"});
    file.write(in("reflectance"), flat(groups.reflectance), bands, {"1", "of materials, as they were solved"});
    file.write(in("exitance"), flat(groups.exitance), bands, {"W/m^2", "likewise"});
    file.write(in("intensity"), flat(groups.intensity), bands, {"W/sr", "of lights without extent, likewise"});
    file.write(in("distant"), flat(groups.distant), bands, {"W/m^2", "irradiance of domes and discs, likewise"});
    write_transport(file, group, groups.transport);
}

LightGroups read_light_groups(Hdf5Reader& file, const std::string& group, const Solution& solution) {
    const auto in = [&](const char* name) { return group + "/" + name; };
    const Scene& scene = solution.scene;
    LightGroups out;
    std::istringstream names(file.read_text(in("names")));
    for (std::string name; std::getline(names, name);) out.groups.emplace_back().emitters.name = name;
    if (out.groups.empty() || out.groups.size() > max_light_groups)
        return file.fail(in("names"), "names no light groups, or too many"), LightGroups();
    read_facts(file, group, out.groups);
    read_emitters(file, group, scene, out);
    read_values(file, in("indirect"), solution.indirect.values.size(), out.groups, &LightGroup::indirect);
    read_values(file, in("interpolant"), solution.interpolant.values.size(), out.groups, &LightGroup::interpolant);
    out.reflectance = spectra(file, in("reflectance"), scene.materials().size());
    out.exitance = spectra(file, in("exitance"), scene.materials().size());
    out.intensity = spectra(file, in("intensity"), scene.lights().size());
    out.distant = spectra(file, in("distant"), scene.distant().domes.size() + scene.distant().discs.size());
    for (const Spectrum& rho : out.reflectance)
        if (!(max(rho) < 1)) file.fail(in("reflectance"), "is not below 1");
    read_transport(file, group, solution, out.transport);
    return file.failed() ? LightGroups() : out;
}

}  // namespace exitance
