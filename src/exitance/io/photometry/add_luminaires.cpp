#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <tuple>

#include "exitance/io/photometry/luminaire_body.hpp"
#include "exitance/io/photometry/luminaire_type.hpp"
#include "exitance/io/photometry/photometric_file.hpp"
#include "exitance/io/photometry/placed_luminaire.hpp"
#include "exitance/scene/add_polygon.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {
namespace {

class Luminaires {
  public:
    Luminaires(SceneDescription& scene, std::vector<Finding>& findings) : scene_(scene), findings_(findings) {}

    double lumens_to_light = 1;
    void add(const PlacedLuminaire& luminaire);
    /// Uses `photometry` for luminaires with this path, in place of a file.
    void use_photometry(const std::string& path, Photometry photometry);

  private:
    /// A photometric file with the faces and the profile made from it.
    struct Lamp {
        bool is_read = false;
        Photometry photometry;
        LuminaireBody body;
        ProfileId profile;
        std::uint32_t type = 0;  ///< Index of the file's type in the scene.
    };
    const Lamp* lamp_of(const PlacedLuminaire& luminaire);
    std::uint32_t material_of(const Lamp& lamp, const PlacedLuminaire& luminaire, double table_exitance, double factor);

    SceneDescription& scene_;
    std::vector<Finding>& findings_;
    std::map<std::string, Lamp> lamps_;
    std::map<std::tuple<std::uint32_t, double, double, std::array<double, 9>>, std::uint32_t> materials_;
    std::size_t count_ = 0;
};

const Luminaires::Lamp* Luminaires::lamp_of(const PlacedLuminaire& luminaire) {
    const auto [at, is_new] = lamps_.try_emplace(luminaire.path);
    Lamp& lamp = at->second;
    if (!is_new) return lamp.is_read ? &lamp : nullptr;
    Result<Photometry> read = load_photometry(luminaire.path);
    if (!read) {
        const Error& e = read.error();
        findings_.push_back({Finding::Kind::error, luminaire.file, luminaire.line,
                             fmt::format("its luminaire cannot be read: {}: {}", e.where, e.message), e.hint});
        return nullptr;
    }
    findings_.insert(findings_.end(), read->findings.begin(), read->findings.end());
    use_photometry(luminaire.path, std::move(*read));
    return &lamp;
}

void Luminaires::use_photometry(const std::string& path, Photometry photometry) {
    Lamp& lamp = lamps_[path];
    lamp.photometry = std::move(photometry);
    lamp.body = make_luminaire_body(lamp.photometry);
    lamp.profile = ProfileId(scene_.profiles.size());
    scene_.profiles.push_back(lamp.body.profile);
    lamp.type = static_cast<std::uint32_t>(scene_.luminaire_types.size());
    scene_.luminaire_types.push_back(luminaire_type_of(lamp.photometry));
    lamp.is_read = true;
}

/// Returns the material of a luminaire's face; faces with equal emission share a material.
std::uint32_t Luminaires::material_of(const Lamp& lamp, const PlacedLuminaire& luminaire, double table_exitance,
                                      double factor) {
    const auto world = [&](const Vec3& v) { return v.x * luminaire.x + v.y * luminaire.y + v.z * luminaire.z; };
    const LuminaireBody& body = lamp.body;
    DirectedEmission emission;
    emission.profile = lamp.profile;
    emission.x = world(body.axis_x), emission.y = world(body.axis_y), emission.z = world(body.axis_z);
    std::array<double, 9> turn;
    std::size_t next = 0;
    for (const Vec3& v : {emission.x, emission.y, emission.z})
        for (const double c : {v.x, v.y, v.z}) turn[next++] = c;
    const auto number = static_cast<std::uint32_t>(scene_.materials.size());
    const auto [at, is_new] = materials_.try_emplace({lamp.profile.value, table_exitance, factor, turn}, number);
    if (!is_new) return at->second;
    Material material;
    material.name = "luminaire " + std::filesystem::path(lamp.photometry.file).filename().string();
    material.exitance = Spectrum(table_exitance * factor);
    if (material.emits()) {
        emission.scale = pi / table_exitance;
        material.emission = emission;
    }
    scene_.materials.push_back(std::move(material));
    return number;
}

void Luminaires::add(const PlacedLuminaire& luminaire) {
    const Lamp* lamp = lamp_of(luminaire);
    ++count_;
    if (!lamp) return;
    const Photometry& photometry = lamp->photometry;
    const double output = luminaire.lumens ? *luminaire.lumens / photometry.lamp_lumens.value_or(photometry.flux()) : 1;
    const double factor = output * luminaire.dimming * luminaire.maintenance * lumens_to_light;
    const auto group = static_cast<std::uint32_t>(scene_.groups.size());
    scene_.luminaires.push_back({lamp->type, group, luminaire.position,
                                 output * scene_.luminaire_types[lamp->type].flux, luminaire.maintenance});
    scene_.groups.push_back(fmt::format("{} #{}", luminaire.group.empty() ? "luminaire" : luminaire.group, count_));
    for (const LuminaireBody::Face& face : lamp->body.faces) {
        SceneDescription::Face& out = add_polygon(scene_, face.corners, [&](const Point& p) {
            return luminaire.position + p.x * luminaire.x + p.y * luminaire.y + p.z * luminaire.z;
        });
        out.material = material_of(*lamp, luminaire, face.exitance, factor);
        out.group = group;
    }
}

}  // namespace

void add_luminaire(const Photometry& photometry, const PlacedLuminaire& luminaire, SceneDescription& scene) {
    std::vector<Finding> none;
    Luminaires one(scene, none);
    one.use_photometry(luminaire.path, photometry);
    one.add(luminaire);
}

bool emits_light(const SceneDescription& scene) {
    const auto emits = [&](const SceneDescription::Face& face) { return scene.materials[face.material].emits(); };
    return !scene.lights.empty() || std::any_of(scene.faces.begin(), scene.faces.end(), emits);
}

void add_luminaires(const std::vector<PlacedLuminaire>& luminaires, std::optional<bool> photometric,
                    SceneDescription& scene, std::vector<Finding>& findings) {
    if (luminaires.empty()) return;
    const bool in_lumens = photometric.value_or(scene.photometric || !emits_light(scene));
    if (!in_lumens && !photometric)
        findings.push_back(
            {Finding::Kind::warning, scene.file, 0,
             fmt::format("the light of the scene is in watts: that of the luminaires is converted to W by {:g} lm/W",
                         daylight_efficacy),
             "--quantity photometric takes the scene's own light as given in cd/m^2"});
    scene.photometric = in_lumens;
    Luminaires all(scene, findings);
    if (!in_lumens) all.lumens_to_light = 1 / daylight_efficacy;
    for (const PlacedLuminaire& luminaire : luminaires) all.add(luminaire);
}

}  // namespace exitance
