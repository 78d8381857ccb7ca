#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "exitance/error/area_samples.hpp"
#include "exitance/io/export/conforming_mesh.hpp"
#include "exitance/io/export/export.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/transport/stage.hpp"
#include "support/sample_solution.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

using nlohmann::json;

/// A .glb file, parsed by the glTF 2.0 specification.
struct Glb {
    json text;
    std::string binary;

    explicit Glb(const std::string& content) {
        EXPECT_EQ(content.substr(0, 4), "glTF");
        EXPECT_EQ(word(content, 4), 2u);
        EXPECT_EQ(word(content, 8), content.size());
        const std::uint32_t length = word(content, 12);
        EXPECT_EQ(length % 4, 0u);
        EXPECT_EQ(content.substr(16, 4), "JSON");
        text = json::parse(content.substr(20, length));
        EXPECT_EQ(word(content, 20 + length), content.size() - 28 - length);
        EXPECT_EQ(content.substr(24 + length, 4), std::string("BIN\0", 4));
        binary = content.substr(28 + length);
        EXPECT_EQ(binary.size() % 4, 0u);
        EXPECT_EQ(text["buffers"][0]["byteLength"], binary.size());
    }
    static std::uint32_t word(const std::string& bytes, std::size_t at) {
        std::uint32_t value = 0;
        std::memcpy(&value, bytes.data() + at, 4);
        return value;
    }
    /// Returns the numbers of an accessor and checks that they are within its view, and the view within the buffer.
    template <class T>
    std::vector<T> numbers(const json& index) const {
        const json& a = text["accessors"][index.get<std::size_t>()];
        const json& view = text["bufferViews"][a["bufferView"].get<std::size_t>()];
        const std::size_t columns = a["type"] == "VEC3" ? 3 : 1, count = columns * a["count"].get<std::size_t>();
        EXPECT_EQ(a["componentType"], (std::is_same_v<T, float> ? 5126 : 5125));
        EXPECT_LE(a["byteOffset"].get<std::size_t>() + 4 * count, view["byteLength"].get<std::size_t>());
        const std::size_t at = a["byteOffset"].get<std::size_t>() + view["byteOffset"].get<std::size_t>();
        EXPECT_LE(at + 4 * count, binary.size());
        EXPECT_EQ(at % 4, 0u);
        std::vector<T> out(count);
        std::memcpy(out.data(), binary.data() + at, 4 * count);
        return out;
    }
};

Vec3 row(const std::vector<float>& values, std::size_t i) {
    return {static_cast<double>(values[3 * i]), static_cast<double>(values[3 * i + 1]),
            static_cast<double>(values[3 * i + 2])};
}

Glb exported(const Solution& solution) {
    const TemporaryFolder folder;
    const Result<void> written = export_solution(solution, folder / "s.glb");
    EXPECT_TRUE(written);
    return Glb(*read_whole_file(folder / "s.glb"));
}

TEST(ExportGlb, EveryAccessorSatisfiesTheSpecification) {
    const Glb glb = exported(sample_solution(300));
    EXPECT_EQ(glb.text["asset"]["version"], "2.0");
    EXPECT_EQ(glb.text["nodes"].size(), glb.text["meshes"].size() + glb.text["cameras"].size() +
                                            glb.text["extensions"]["KHR_lights_punctual"]["lights"].size());
    std::size_t triangles = 0;
    for (const json& mesh : glb.text["meshes"])
        for (const json& primitive : mesh["primitives"]) {
            const json& attributes = primitive["attributes"];
            const auto position = glb.numbers<float>(attributes["POSITION"]),
                       normal = glb.numbers<float>(attributes["NORMAL"]);
            const auto colour = glb.numbers<float>(attributes["COLOR_0"]);
            const auto index = glb.numbers<std::uint32_t>(primitive["indices"]);
            ASSERT_EQ(normal.size(), position.size());
            ASSERT_EQ(colour.size(), position.size());
            ASSERT_EQ(index.size() % 3, 0u);
            triangles += index.size() / 3;
            for (const std::uint32_t i : index) ASSERT_LT(3 * i, position.size());
            const json& bounds = glb.text["accessors"][attributes["POSITION"].get<std::size_t>()];
            for (std::size_t k = 0; k < position.size(); ++k) {
                EXPECT_GE(position[k], bounds["min"][k % 3].get<float>());
                EXPECT_LE(position[k], bounds["max"][k % 3].get<float>());
                EXPECT_TRUE(colour[k] >= 0 && colour[k] <= 1);
            }
            for (std::size_t i = 0; i < index.size(); i += 3) {
                const Point a = row(position, index[i]), b = row(position, index[i + 1]),
                            c = row(position, index[i + 2]);
                // The triangle has an area, and its normal points to the front.
                EXPECT_GT(dot(cross(b - a, c - a), row(normal, index[i])), 0);
                EXPECT_NEAR(norm(row(normal, index[i])), 1, 1e-6);
            }
            const json& material = glb.text["materials"][primitive["material"].get<std::size_t>()];
            const json& surface = material["pbrMetallicRoughness"];
            EXPECT_EQ(surface["metallicFactor"], 0);
            const auto B = glb.numbers<float>(attributes["_RADIOSITY"]),
                       E = glb.numbers<float>(attributes["_IRRADIANCE"]);
            for (std::size_t k = 0; k < B.size(); ++k) {
                double M = 0;  // pi times the emitted radiance
                if (material.contains("emissiveFactor"))
                    M = pi * material["emissiveFactor"][k % 3].get<double>() *
                        material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"].get<double>();
                const double rho = surface["baseColorFactor"][k % 3].get<double>();
                EXPECT_NEAR(static_cast<double>(B[k]), M + rho * static_cast<double>(E[k]), 1e-4 * (1 + M));
            }
        }
    EXPECT_GT(triangles, 600u);
}

TEST(ExportGlb, IsReadBackWithTheSameSurfacesAndDirectLight) {
    if (bands != 3) return;
    const TemporaryFolder folder;
    const Solution solution = sample_solution(300);
    ASSERT_TRUE(export_solution(solution, folder / "s.glb"));
    const CheckedScene back = load_scene(folder / "s.glb");
    ASSERT_TRUE(back.scene);
    EXPECT_EQ(back.scene->regions().size(), solution.scene.regions().size());
    EXPECT_EQ(back.scene->groups().size(), solution.scene.groups().size());
    ASSERT_EQ(back.scene->lights().size(), solution.scene.lights().size());
    ASSERT_EQ(back.scene->cameras().size(), solution.scene.cameras().size());
    const SceneCamera &camera = solution.scene.cameras()[0], &again = back.scene->cameras()[0];
    EXPECT_EQ(again.name, camera.name);
    EXPECT_NEAR(again.fov, camera.fov, 1e-9);
    EXPECT_NEAR(norm(normalized(again.target - again.eye) - normalized(camera.target - camera.eye)), 0, 1e-12);
    double light = 0, difference = 0;
    const Stage before(solution.scene), after(*back.scene);
    DirectLight::Workspace workspace;
    for (const ProbePoint& p : points_uniform_in_area(solution.scene, 300, 1)) {
        const Point above = p.x + 1e-4 * p.n;  // in front of both scenes' surfaces, which differ by micrometres
        const Spectrum a = before.direct.irradiance(above, p.n, RegionId(), workspace);
        const Spectrum b = after.direct.irradiance(above, p.n, RegionId(), workspace);
        light += mean(a), difference += std::abs(mean(a - b));
    }
    EXPECT_LT(difference, 1e-5 * light);  // coordinates in single precision have errors of 1e-7 of the room's size
}

TEST(ConformingMesh, HasNoCornerOnAnEdgeOfItsRegion) {
    const ElementMesh mesh = make_element_mesh(sample_solution(200));
    const ConformingMesh conforming = make_conforming(mesh);
    const ElementMesh& m = conforming.mesh;
    double before = 0, after = 0;
    const auto area = [](const ElementMesh& of, std::size_t i, std::size_t count) {
        return norm(area_vector(std::span(of.points).subspan(of.first_point[i], count)));
    };
    for (std::size_t i = 0; i < mesh.size(); ++i) before += area(mesh, i, mesh.corner_count(i));
    for (std::size_t i = 0; i < m.size(); ++i) {
        const std::size_t count = m.corner_count(i) - (conforming.has_middle[i] ? 1 : 0);
        after += area(m, i, count);
        for (std::size_t k = 0; k < count; ++k) {
            const Point a = m.points[m.first_point[i] + k], b = m.points[m.first_point[i] + (k + 1) % count];
            for (std::size_t other = 0; other < m.size(); ++other) {
                if (m.region[other] != m.region[i]) continue;
                for (std::uint32_t p = m.first_point[other]; p < m.first_point[other + 1]; ++p) {
                    const double t = dot(m.points[p] - a, b - a) / squared_norm(b - a);
                    const double length = norm(b - a);
                    if (t * length < 1e-5 || (1 - t) * length < 1e-5) continue;
                    EXPECT_GT(norm(m.points[p] - a - t * (b - a)), 1e-7);
                }
            }
        }
    }
    EXPECT_NEAR(after, before, 1e-5 * before);
}

}  // namespace
}  // namespace exitance
