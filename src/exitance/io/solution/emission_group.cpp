#include "exitance/io/solution/solution_groups.hpp"
#include "exitance/io/solution/stored_columns.hpp"

namespace exitance {
namespace {

constexpr std::uint32_t diffuse = ProfileId().value;

template <class T>
void append(std::vector<T>& all, const std::vector<T>& more) {
    all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

void write_emission(Hdf5Writer& file, const std::string& group, const Field<MaterialId, Material>& materials,
                    const Field<ProfileId, EmissionProfile>& profiles) {
    if (profiles.size() == 0) return;
    const auto in = [&](const char* name) { return group + "/" + name; };
    std::vector<std::uint8_t> body, kind;
    std::vector<std::uint32_t> count;
    std::vector<double> offset, angles, values;
    std::vector<Vec3> sizes, axes;
    for (const EmissionProfile& p : profiles) {
        body.push_back(static_cast<std::uint8_t>(p.body)), sizes.push_back(p.size);
        for (const EmissionProfile::Axis& axis : p.axes) {
            kind.push_back(static_cast<std::uint8_t>(axis.angle)), offset.push_back(axis.offset);
            count.push_back(static_cast<std::uint32_t>(axis.at.size()));
            append(angles, axis.at);
        }
        append(values, p.values);
    }
    file.write(in("profile_body"), body, 1,
               {"1",
                "what a profile's values are over: 0 nothing, 1 the cosine to the face's normal, 2 the projected area "
                "of a box, 3 that of a cylinder"});
    file.write(in("profile_size"), flat(sizes), 3, {"m", "size of that box; diameter and height of that cylinder"});
    file.write(in("profile_angle_kind"), kind, 2,
               {"1", "what a profile's two angles are: 0 theta, 1 phi, 2 phi2, 3 phi4, 4 to 7 of type B"});
    file.write(in("profile_angle_offset"), offset, 2, {"degree", "added to an angle before the table is entered"});
    file.write(in("profile_angle_count"), count, 2, {"1", "entries of a profile's table along its two angles"});
    file.write(in("profile_angle"), angles, 1, {"degree", "angles of the tables, one axis after the other"});
    file.write(in("profile_value"), values, 1,
               {"1",
                "radiance or intensity over a factor of each material, the second angle fastest, one table after "
                "the other"});
    std::vector<std::uint32_t> profile;
    std::vector<double> scale;
    for (const Material& m : materials) {
        profile.push_back(m.emission.profile.value), scale.push_back(m.emission.scale);
        axes.insert(axes.end(), {m.emission.x, m.emission.y, m.emission.z});
    }
    file.write(in("material_profile"), profile, 1,
               {"1", "row of a material's profile; 4294967295: it emits diffusely"});
    file.write(in("material_lamp_axes"), flat(axes), 9, {"1", "axes of the lamp's frame: x, y, z"});
    file.write(in("material_profile_scale"), scale, 1,
               {"1", "pi L / M is so many times the value of the profile, M the material's exitance"});
}

Field<ProfileId, EmissionProfile> read_profiles(Hdf5Reader& file, const std::string& group) {
    Field<ProfileId, EmissionProfile> out;
    if (!file.has(group + "/profile_body")) return out;
    Columns in(file, group);
    const auto body = in.read<std::uint8_t>("profile_body");
    const std::size_t profiles = body.size();
    const auto sizes = in.points("profile_size", profiles);
    const auto kind = in.read<std::uint8_t>("profile_angle_kind", 2, profiles);
    const auto offset = in.read<double>("profile_angle_offset", 2, profiles);
    const auto count = in.read<std::uint32_t>("profile_angle_count", 2, profiles);
    const auto angles = in.read<double>("profile_angle");
    const auto values = in.read<double>("profile_value");
    if (file.failed()) return out;
    std::size_t angle = 0, value = 0;
    for (std::size_t i = 0; i < profiles; ++i) {
        EmissionProfile p;
        p.body = static_cast<EmissionProfile::Body>(body[i]), p.size = sizes[i];
        for (std::size_t k = 2 * i; k < 2 * i + 2; ++k) {
            if (count[k] > angles.size() - angle)
                return file.fail(group + "/profile_angle_count", "refers to angles that do not exist"), out;
            const auto first = angles.begin() + static_cast<std::ptrdiff_t>(angle);
            p.axes[k - 2 * i] = {static_cast<EmissionProfile::Angle>(kind[k]), offset[k], {first, first + count[k]}};
            angle += count[k];
        }
        const std::size_t entries = p.axes[0].at.size() * p.axes[1].at.size();
        if (entries > values.size() - value)
            return file.fail(group + "/profile_value", "holds fewer values than its angles require"), out;
        const auto first = values.begin() + static_cast<std::ptrdiff_t>(value);
        p.values.assign(first, first + static_cast<std::ptrdiff_t>(entries));
        value += entries;
        if (!p.is_sane())
            return file.fail(group + "/profile_value", "and related data sets do not form a valid emission profile"),
                   out;
        p.find_smooth_width();
        out.add(std::move(p));
    }
    return out;
}

std::vector<DirectedEmission> read_emission(Hdf5Reader& file, const std::string& group, std::size_t material_count,
                                            std::size_t profile_count) {
    std::vector<DirectedEmission> out(material_count);
    if (!file.has(group + "/material_profile")) return out;
    Columns in(file, group);
    const auto profile = in.read<std::uint32_t>("material_profile", 1, material_count);
    const auto axes = in.read<double>("material_lamp_axes", 9, material_count);
    const auto scale = in.read<double>("material_profile_scale", 1, material_count);
    for (std::size_t i = 0; i < material_count && !file.failed(); ++i) {
        if (profile[i] == diffuse) continue;
        const double* a = &axes[9 * i];
        out[i] = {ProfileId(profile[i]), {a[0], a[1], a[2]}, {a[3], a[4], a[5]}, {a[6], a[7], a[8]}, scale[i]};
        if (profile[i] >= profile_count || !out[i].is_sane())
            file.fail(group + "/material_profile", "and the other data sets do not describe an emission");
    }
    return out;
}

}  // namespace exitance
