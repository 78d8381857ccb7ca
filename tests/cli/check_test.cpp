#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>

#include "cli/small_scene.hpp"
#include "support/gltf_text.hpp"

namespace exitance::test {

using OrderedJson = nlohmann::ordered_json;

namespace {

std::vector<std::string> keys(const OrderedJson& json) {
    std::vector<std::string> names;
    for (const auto& [name, value] : json.items()) names.push_back(name);
    return names;
}

using Polygons = std::vector<std::vector<Point>>;

/// Faces of a box that look inwards or outwards.
Polygons box(const Point& lo, const Point& hi, bool inwards) {
    const auto corner = [&](int i) { return Point{i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z}; };
    Polygons out;
    for (const std::array<int, 4>& face : std::vector<std::array<int, 4>>{
             {0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}) {
        std::vector<Point>& corners = out.emplace_back();
        for (const int i : face) corners.push_back(corner(i));
        if (!inwards) std::reverse(corners.begin(), corners.end());
    }
    return out;
}

/// A room with a cupboard on its floor against a wall; the cupboard is inside out if `is_wrong`.
Polygons furnished_room(bool is_wrong) {
    Polygons out = box({0, 0, 0}, {4, 3, 2.5}, true);
    for (auto& face : box({1, 0, 0}, {2, 0.5, 1.8}, is_wrong)) out.push_back(face);
    return out;
}

std::string write_obj(const TemporaryFolder& folder, const std::string& name, const Polygons& faces) {
    std::ostringstream out;
    out << "mtllib room.mtl\nusemtl grey\ng all\n";
    for (const auto& face : faces) {
        for (const Point& p : face) out << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
        out << "f -4 -3 -2 -1\n";
    }
    // A lamp that shines down.
    out << "usemtl lamp\ng lamp\nv 1.5 1 2.4\nv 1.5 2 2.4\nv 2.5 2 2.4\nv 2.5 1 2.4\nf -4 -3 -2 -1\n";
    write_text(folder / "room.mtl", "newmtl grey\nKd 0.5 0.5 0.5\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n");
    write_text(folder / name, out.str());
    return folder / name;
}

std::string write_stl(const TemporaryFolder& folder, const Polygons& faces) {
    std::ostringstream out;
    out << "solid room\n";
    for (const auto& face : faces)
        for (const std::size_t i : {1, 2}) {
            out << "facet normal 0 0 0\nouter loop\n";
            for (const Point& p : {face[0], face[i], face[i + 1]})
                out << "vertex " << p.x << ' ' << p.y << ' ' << p.z << '\n';
            out << "endloop\nendfacet\n";
        }
    out << "endsolid\n";
    write_text(folder / "room.stl", out.str());
    return folder / "room.stl";
}

std::string write_gltf(const TemporaryFolder& folder, const Polygons& faces) {
    GltfText text;
    std::vector<Point> points;
    std::vector<std::uint16_t> indices;
    for (const auto& face : faces)
        for (const std::size_t i : {1, 2})
            for (const Point& p : {face[0], face[i], face[i + 1]}) {
                indices.push_back(static_cast<std::uint16_t>(points.size()));
                points.push_back({p.x, p.z, -p.y});  // Y is up there
            }
    text.positions(points), text.indices(indices);
    text.meshes = R"({"primitives":[{"attributes":{"POSITION":0},"indices":1}]})";
    text.nodes = R"({"mesh":0,"name":"room"})";
    write_text(folder / "room.glb", text.glb());
    return folder / "room.glb";
}

std::string write_rad(const TemporaryFolder& folder, const Polygons& faces) {
    std::ostringstream out;
    out << "void plastic grey 0 0 5 .5 .5 .5 0 0\n";
    for (std::size_t f = 0; f < faces.size(); ++f) {
        out << "grey polygon f" << f << " 0 0 12";
        for (const Point& p : faces[f]) out << "  " << p.x << ' ' << p.y << ' ' << p.z;
        out << '\n';
    }
    write_text(folder / "room.rad", out.str());
    return folder / "room.rad";
}

/// How many findings of a kind name a body that is inside out.
std::size_t inside_out(const OrderedJson& checked, const std::string& kind) {
    return static_cast<std::size_t>(
        std::count_if(checked[kind].begin(), checked[kind].end(), [](const OrderedJson& finding) {
            return finding["message"].get<std::string>().find("closed body") != std::string::npos;
        }));
}

}  // namespace

TEST(ProgramCheck, AValidSceneIsUsableAndItsPartsAreCounted) {
    const TemporaryFolder folder;
    const Finished run = run_program({"check", write_small_room(folder)});
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(run.err, "");
    EXPECT_NE(run.out.find("The scene can be used: 7 surfaces"), std::string::npos) << run.out;
}

TEST(ProgramCheck, JsonHasTheKeysOfTheContract) {
    const TemporaryFolder folder;
    const OrderedJson json = OrderedJson::parse(run_program({"check", "--json", write_small_room(folder)}).out);
    EXPECT_EQ(keys(json), (std::vector<std::string>{"surfaces", "errors", "warnings", "repairs"}));
    EXPECT_EQ(json["surfaces"], 7);
    EXPECT_TRUE(json["errors"].empty());
}

TEST(ProgramCheck, ABrokenSceneIsBadInputWithFileAndLine) {
    const TemporaryFolder folder;
    const std::string scene = write_broken_scene(folder);
    const Finished run = run_program({"check", scene});
    EXPECT_EQ(run.status, 3);
    EXPECT_NE(run.err.find("error: " + scene + ":9: "), std::string::npos) << run.err;

    const Finished as_json = run_program({"check", scene, "--json"});
    EXPECT_EQ(as_json.status, 3);
    const OrderedJson json = OrderedJson::parse(as_json.out);
    ASSERT_EQ(json["errors"].size(), 1u);
    EXPECT_EQ(keys(json["errors"][0]), (std::vector<std::string>{"file", "line", "message"}));
    EXPECT_EQ(json["errors"][0]["line"], 9);
    EXPECT_EQ(json["errors"][0]["file"], scene);
}

TEST(ProgramCheck, MarksFindingsInAPictureEvenOfABrokenScene) {
    const TemporaryFolder folder;
    for (const bool broken : {false, true}) {
        const std::string scene = broken ? write_broken_scene(folder) : write_small_room(folder);
        const std::string picture = folder / (broken ? "broken.png" : "sound.png");
        const Finished run = run_program({"check", scene, "--picture", picture});
        EXPECT_EQ(run.status, broken ? 3 : 0);
        std::ifstream in(picture, std::ios::binary);
        std::string magic(4, ' ');
        in.read(magic.data(), 4);
        EXPECT_EQ(magic, "\x89PNG");
    }
    EXPECT_EQ(run_program({"check", folder / "room.obj", "--picture", folder / "p.jpg"}).status, 2);
}

TEST(ProgramCheck, AFaceWithReversedOrientationIsNamed) {
    const TemporaryFolder folder;
    write_text(folder / "box.mtl", "newmtl grey\nKd 0.5 0.5 0.5\nKe 1 1 1\n");
    write_text(folder / "box.obj",
               "mtllib box.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
               "usemtl grey\ng crate\nf 1 2 3 4\nf 8 7 6 5\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 1 5 8 4\n");
    const OrderedJson json = OrderedJson::parse(run_program({"check", "--json", folder / "box.obj"}).out);
    ASSERT_EQ(json["warnings"].size(), 1u);
    EXPECT_EQ(json["warnings"][0]["line"], 17);
    EXPECT_NE(json["warnings"][0]["message"].get<std::string>().find("'crate'"), std::string::npos);
}

TEST(ProgramCheck, BodiesThatAreInsideOutAreNamedInEveryFormatAndTurnedOnRequest) {
    const TemporaryFolder folder;
    for (const bool is_wrong : {true, false}) {
        const Polygons faces = furnished_room(is_wrong);
        for (const std::string& file :
             {write_obj(folder, "room.obj", faces), write_stl(folder, faces), write_gltf(folder, faces)}) {
            const OrderedJson as_it_is = OrderedJson::parse(run_program({"check", "--json", file}).out);
            EXPECT_EQ(inside_out(as_it_is, "warnings"), is_wrong ? 1u : 0u) << file;
            EXPECT_EQ(inside_out(as_it_is, "repairs"), 0u) << file;
            const OrderedJson turned = OrderedJson::parse(run_program({"check", "--json", "--turn-bodies", file}).out);
            EXPECT_EQ(inside_out(turned, "warnings"), 0u) << file;
            EXPECT_EQ(inside_out(turned, "repairs"), is_wrong ? 1u : 0u) << file;
        }
        // Radiance's polygons have two sides.
        const OrderedJson of_radiance =
            OrderedJson::parse(run_program({"check", "--json", write_rad(folder, faces)}).out);
        EXPECT_EQ(inside_out(of_radiance, "warnings"), 0u);
    }
}

TEST(ProgramCheck, ATurnedBodyHasTheLightOfOneThatWasRightFromTheBeginning) {
    const TemporaryFolder folder;
    const std::string right = write_obj(folder, "right.obj", furnished_room(false)),
                      wrong = write_obj(folder, "wrong.obj", furnished_room(true));
    const auto light = [&](const std::string& scene, std::vector<std::string> options) {
        options.insert(options.begin(), {"solve", scene, "-o", folder / "s.h5", "--error", "0.05", "-q"});
        EXPECT_EQ(run_program(options).status, 0);
        return run_program({"probe", folder / "s.h5", "--points", "-", "-o", "-"},
                           "x,y,z,nx,ny,nz\n1.5,0.25,1.8,0,0,1\n1.5,0.5,1,0,1,0\n2,2,0,0,0,1\n")
            .out;
    };
    const auto numbers = [](const std::string& csv) {
        std::vector<double> out;
        std::istringstream lines(csv);
        std::string line;
        std::getline(lines, line);
        while (std::getline(lines, line)) {
            for (int column = 0; column < 6; ++column) line.erase(0, line.find(',') + 1);  // x,y,z,nx,ny,nz
            out.push_back(std::stod(line));                                                // E_r
        }
        return out;
    };
    const std::vector<double> expected = numbers(light(right, {})), turned = numbers(light(wrong, {"--turn-bodies"}));
    ASSERT_EQ(expected.size(), 3u);
    ASSERT_EQ(turned.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_GT(expected[i], 0);
        EXPECT_NEAR(turned[i], expected[i], 0.05 * expected[i]);  // the error requested
    }
}

TEST(ProgramCheck, AMissingFileIsBadInput) {
    for (const char* verb : {"check", "solve"}) {
        const TemporaryFolder folder;
        std::vector<std::string> arguments{verb, folder / "absent.obj"};
        if (verb == std::string("solve")) arguments.insert(arguments.end(), {"-o", folder / "s.h5"});
        const Finished run = run_program(arguments);
        EXPECT_EQ(run.status, 3) << verb;
        EXPECT_EQ(run.err.find("error: "), 0u) << run.err;
        EXPECT_NE(run.err.find("absent.obj"), std::string::npos) << run.err;
        EXPECT_EQ(folder.count(), 0u) << "nothing is left behind";
    }
}

}  // namespace exitance::test
