#include "exitance/io/solution/sky_group.hpp"

#include "exitance/io/solution/stored_columns.hpp"
#include "exitance/scene/sky/sky_picture.hpp"

namespace exitance {
namespace {

constexpr std::size_t numbers = 9;  ///< Numbers per sky.
enum Flags : std::uint8_t { intermediate = 1, blends_ground = 2, below = 4, picture = 8, all_flags = 15 };

/// Writes the tables of all skies from pictures, one after another.
void write_pictures(Hdf5Writer& file, const std::string& name, const DistantLight& light) {
    std::vector<double> values;
    for (const DistantLight::Dome& dome : light.domes)
        if (dome.model.picture)
            values.insert(values.end(), dome.model.picture->values().begin(), dome.model.picture->values().end());
    if (values.empty()) return;
    file.write(name, values, SkyPicture::columns,
               {"1",
                "radiance of each sky from a picture, up to its factor: 64 rows from straight down to the zenith, "
                "columns from +x counter-clockwise"});
}

/// Reads the tables of write_pictures() into the domes that `kind` marks.
void read_pictures(Columns& in, std::span<const std::uint8_t> kind, Hdf5Reader& file, DistantLight& light) {
    std::size_t count = 0, next = 0;
    for (const std::uint8_t k : kind) count += (k & picture) != 0;
    if (count == 0) return;
    const auto values = in.read<double>("sky_picture", SkyPicture::columns, count * SkyPicture::rows);
    for (std::size_t i = 0; i < kind.size() && !file.failed(); ++i) {
        if (!(kind[i] & picture)) continue;
        const auto first = values.begin() + static_cast<std::ptrdiff_t>(next++ * SkyPicture::size);
        light.domes[i].model.picture = std::make_shared<const SkyPicture>(
            std::vector<double>(first, first + static_cast<std::ptrdiff_t>(SkyPicture::size)));
    }
}

}  // namespace

void write_sky(Hdf5Writer& file, const std::string& group, const DistantLight& light) {
    const auto in = [&](const char* name) { return group + "/" + name; };
    if (!light.domes.empty()) {
        std::vector<double> values;
        for (const DistantLight::Dome& dome : light.domes) {
            const SkyModel& m = dome.model;
            values.insert(values.end(), {m.a, m.b, m.g, m.f0, m.c, m.d, m.e, m.ground, m.scale});
        }
        file.write(in("sky_model"), values, numbers,
                   {"1",
                    "a, b, g, f0, c, d, e of a sky, what the ground's is where both blend, and a factor: pi L / E "
                    "= factor (1 + a exp(b / cos Z) + g cos Z) (f0 + c exp(d gamma) + e cos^2 gamma)"});
        file.write(in("sky_kind"),
                   column<std::uint8_t>(light.domes,
                                        [](const DistantLight::Dome& d) {
                                            return (d.model.intermediate ? intermediate : 0) +
                                                   (d.model.blends_ground ? blends_ground : 0) +
                                                   (d.model.below ? below : 0) + (d.model.picture ? picture : 0);
                                        }),
                   1,
                   {"1",
                    "1: the intermediate sky; 2: sky and ground blend; 4: below the horizon; 8: from a picture; or "
                    "sums of these"});
        file.write(in("sky_sun"),
                   flat(column<Vec3>(light.domes, [](const DistantLight::Dome& d) { return d.model.sun; })), 3,
                   {"1", "towards the sun that a sky goes by"});
        file.write(in("sky_irradiance"), spectra(light.domes, [](const DistantLight::Dome& d) { return d.irradiance; }),
                   bands, {"W/m^2", "irradiance of a horizontal plane by a sky"});
    }
    write_pictures(file, in("sky_picture"), light);
    if (light.discs.empty()) return;
    file.write(in("sun_direction"),
               flat(column<Vec3>(light.discs, [](const DistantLight::Disc& d) { return d.towards; })), 3,
               {"1", "towards a distant disc"});
    file.write(in("sun_half_angle"),
               column<double>(light.discs, [](const DistantLight::Disc& d) { return d.half_angle; }), 1,
               {"rad", "half the angle that a distant disc is seen under"});
    file.write(in("sun_irradiance"), spectra(light.discs, [](const DistantLight::Disc& d) { return d.irradiance; }),
               bands, {"W/m^2", "irradiance of a plane that faces a distant disc"});
}

DistantLight read_sky(Hdf5Reader& file, const std::string& group) {
    DistantLight out;
    Columns in(file, group);
    if (file.has(group + "/sky_model")) {
        const auto kind = in.read<std::uint8_t>("sky_kind");
        const auto values = in.read<double>("sky_model", numbers, kind.size());
        const auto sun = in.normals("sky_sun", kind.size());
        const auto irradiance = in.read<double>("sky_irradiance", bands, kind.size());
        for (std::size_t i = 0; i < kind.size() && !file.failed(); ++i) {
            const double* v = &values[numbers * i];
            SkyModel m;
            m.a = v[0], m.b = v[1], m.g = v[2], m.f0 = v[3], m.c = v[4], m.d = v[5], m.e = v[6], m.ground = v[7];
            m.scale = v[8], m.sun = sun[i];
            m.intermediate = kind[i] & intermediate, m.blends_ground = kind[i] & blends_ground;
            m.below = kind[i] & below;
            if (kind[i] > all_flags) file.fail(group + "/sky_kind", "holds an unknown kind of sky");
            out.domes.push_back({m, spectrum(irradiance, i)});
        }
        if (!file.failed()) read_pictures(in, kind, file, out);
    }
    if (file.has(group + "/sun_direction")) {
        const auto half_angle = in.read<double>("sun_half_angle");
        const auto towards = in.normals("sun_direction", half_angle.size());
        const auto irradiance = in.read<double>("sun_irradiance", bands, half_angle.size());
        for (std::size_t i = 0; i < half_angle.size() && !file.failed(); ++i)
            out.discs.push_back({towards[i], half_angle[i], spectrum(irradiance, i)});
    }
    if (!file.failed() && !out.is_sane())
        file.fail(group + "/sky_model", "and related data sets do not describe valid light");
    return out;
}

void write_panes(Hdf5Writer& file, const std::string& group, const std::vector<Pane>& panes) {
    if (panes.empty()) return;
    const auto in = [&](const char* name) { return group + "/" + name; };
    std::vector<Point> corners;
    for (const Pane& pane : panes) corners.insert(corners.end(), pane.corners.begin(), pane.corners.end());
    file.write(in("pane_corner"), flat(corners), 3, {"m", "corners of the panes of glass, one pane after the other"});
    file.write(in("pane_corner_count"), column<std::uint32_t>(panes, [](const Pane& p) { return p.corners.size(); }), 1,
               {"1", "corners of a pane"});
    file.write(in("pane_normal"), flat(column<Vec3>(panes, [](const Pane& p) { return p.n; })), 3,
               {"1", "unit normal of a pane"});
    file.write(in("pane_transmissivity"), spectra(panes, [](const Pane& p) { return p.transmissivity; }), bands,
               {"1", "share of light that passes the inside of a pane once, at right angles"});
    file.write(in("pane_index"), column<double>(panes, [](const Pane& p) { return p.index; }), 1,
               {"1", "index of refraction of a pane"});
}

std::vector<Pane> read_panes(Hdf5Reader& file, const std::string& group) {
    std::vector<Pane> out;
    if (!file.has(group + "/pane_corner")) return out;
    Columns in(file, group);
    const auto corners = in.points("pane_corner");
    const auto counts = in.counts("pane_corner_count", 3, corners.size());
    const auto normals = in.normals("pane_normal", counts.size());
    const auto transmissivity = in.read<double>("pane_transmissivity", bands, counts.size());
    const auto index = in.read<double>("pane_index", 1, counts.size());
    std::size_t next = 0;
    for (std::size_t i = 0; i < counts.size() && !file.failed(); ++i) {
        const auto first = corners.begin() + static_cast<std::ptrdiff_t>(next);
        next += counts[i];
        out.push_back({{first, first + counts[i]}, normals[i], spectrum(transmissivity, i), index[i], 0});
        if (!out.back().is_sane())
            file.fail(group + "/pane_corner", "and related data sets do not describe valid panes");
    }
    return out;
}

}  // namespace exitance
