#include "exitance/io/files/reference_file.hpp"

#include "exitance/io/files/probe_file.hpp"

namespace exitance {

Result<ReferencePoints> load_reference_points(const std::string& path) {
    Result<ProbeReference> probes = load_probe_reference(path);
    if (!probes) return probes.error();
    ReferencePoints out{{}, std::move(probes->irradiance), std::move(probes->standard_errors)};
    for (std::size_t i = 0; i < probes->probes.size(); ++i)
        out.points.push_back({probes->probes.points[i], probes->probes.normals[i]});
    return out;
}

Result<void> write_reference_points(const std::string& path, const ReferencePoints& reference) {
    const bool noisy = !reference.standard_errors.empty();
    Result<ProbeWriter> writer = ProbeWriter::create(path, {.radiosity = false, .standard_errors = noisy});
    if (!writer) return writer.error();
    for (std::size_t i = 0; i < reference.points.size(); ++i)
        writer->add(reference.points[i].x, reference.points[i].n, reference.irradiance[i], {},
                    noisy ? reference.standard_errors[i] : Spectrum());
    return writer->commit();
}

}  // namespace exitance
