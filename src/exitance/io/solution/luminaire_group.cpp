#include "exitance/io/solution/solution_groups.hpp"
#include "exitance/io/solution/stored_columns.hpp"

namespace exitance {

void write_luminaires(Hdf5Writer& file, const std::string& group, const std::vector<LuminaireType>& types,
                      const std::vector<InstalledLuminaire>& luminaires) {
    if (luminaires.empty()) return;
    const auto in = [&](const char* name) { return group + "/" + name; };
    using Type = LuminaireType;
    file.write_texts(in("luminaire_type_name"), column<std::string>(types, [](const Type& t) { return t.name; }),
                     {"1", "manufacturer and product of the types of luminaires"});
    file.write_texts(in("luminaire_type_file"), column<std::string>(types, [](const Type& t) { return t.file; }),
                     {"1", "photometric files of the types of luminaires"});
    std::vector<double> power, curves;
    for (const Type& t : types) {
        power.insert(power.end(), {t.flux, t.watts});
        for (const std::vector<double>* curve : {&t.curves.c0, &t.curves.c90})
            curves.insert(curves.end(), curve->begin(), curve->end());
    }
    file.write(in("luminaire_type_flux_power"), power, 2, {"lm, W", "flux and power of a type; power 0: unknown"});
    file.write(in("luminaire_type_curve"), curves, 2 * IntensityCurves::size,
               {"cd", "intensity of a type in C180-C0, then in C270-C90, per degree from straight down"});
    file.write(in("luminaire_type_curve_per_kilolumen"),
               column<std::uint8_t>(types, [](const Type& t) { return t.curves.is_per_kilolumen; }), 1,
               {"1", "1: the intensities are for 1000 lm of the lamps"});
    using Installed = InstalledLuminaire;
    file.write(in("luminaire_type"), column<std::uint32_t>(luminaires, [](const Installed& l) { return l.type; }), 1,
               {"1", "row of a luminaire's type"});
    file.write(in("luminaire_group"), column<std::uint32_t>(luminaires, [](const Installed& l) { return l.group; }), 1,
               {"1", "row of the group of a luminaire's faces"});
    file.write(in("luminaire_position"), flat(column<Point>(luminaires, [](const Installed& l) { return l.position; })),
               3, {"m", "centre of a luminaire's opening"});
    std::vector<double> output;
    for (const Installed& l : luminaires) output.insert(output.end(), {l.flux, l.maintenance});
    file.write(in("luminaire_flux_maintenance"), output, 2,
               {"lm, 1", "flux of the new luminaire at full output, and its maintenance factor"});
}

std::vector<LuminaireType> read_luminaire_types(Hdf5Reader& file, const std::string& group) {
    if (!file.has(group + "/luminaire_type_name")) return {};
    Columns in(file, group);
    constexpr std::size_t size = IntensityCurves::size;
    const std::vector<std::string> names = file.read_texts(group + "/luminaire_type_name"),
                                   files = file.read_texts(group + "/luminaire_type_file");
    const auto power = in.read<double>("luminaire_type_flux_power", 2, names.size());
    const auto curves = in.read<double>("luminaire_type_curve", 2 * size, names.size());
    const auto relative = in.read<std::uint8_t>("luminaire_type_curve_per_kilolumen", 1, names.size());
    if (!file.failed() && files.size() != names.size())
        file.fail(group + "/luminaire_type_file", "does not have a row per type");
    for (const double value : power)
        if (!file.failed() && value < 0) file.fail(group + "/luminaire_type_flux_power", "holds a negative value");
    for (const double value : curves)
        if (!file.failed() && value < 0) file.fail(group + "/luminaire_type_curve", "holds a negative intensity");
    std::vector<LuminaireType> out;
    for (std::size_t i = 0; i < names.size() && !file.failed(); ++i) {
        LuminaireType& type = out.emplace_back();
        type.name = names[i], type.file = files[i], type.flux = power[2 * i], type.watts = power[2 * i + 1];
        const auto first = curves.begin() + static_cast<std::ptrdiff_t>(2 * size * i), middle = first + size;
        type.curves.c0.assign(first, middle), type.curves.c90.assign(middle, middle + size);
        type.curves.is_per_kilolumen = relative[i] != 0;
    }
    return out;
}

std::vector<InstalledLuminaire> read_luminaires(Hdf5Reader& file, const std::string& group, std::size_t type_count,
                                                std::size_t group_count) {
    if (type_count == 0) return {};
    Columns in(file, group);
    const auto type = in.indices("luminaire_type", type_count);
    const auto groups = in.indices("luminaire_group", group_count, type.size());
    const auto position = in.points("luminaire_position", type.size());
    const auto output = in.read<double>("luminaire_flux_maintenance", 2, type.size());
    for (std::size_t i = 0; i < output.size() && !file.failed(); ++i)
        if (output[i] < 0) file.fail(group + "/luminaire_flux_maintenance", "holds a negative value");
    std::vector<InstalledLuminaire> out;
    for (std::size_t i = 0; i < type.size() && !file.failed(); ++i)
        out.push_back({type[i], groups[i], position[i], output[2 * i], output[2 * i + 1]});
    return out;
}

}  // namespace exitance
