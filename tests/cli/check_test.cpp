#include <gtest/gtest.h>

#include <fstream>

#include <nlohmann/json.hpp>

#include "cli/small_scene.hpp"

namespace exitance::test {

using Json = nlohmann::ordered_json;

namespace {

std::vector<std::string> keys(const Json& json) {
    std::vector<std::string> names;
    for (const auto& [name, value] : json.items()) names.push_back(name);
    return names;
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
    const Json json = Json::parse(run_program({"check", "--json", write_small_room(folder)}).out);
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
    const Json json = Json::parse(as_json.out);
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
    const Json json = Json::parse(run_program({"check", "--json", folder / "box.obj"}).out);
    ASSERT_EQ(json["warnings"].size(), 1u);
    EXPECT_EQ(json["warnings"][0]["line"], 17);
    EXPECT_NE(json["warnings"][0]["message"].get<std::string>().find("'crate'"), std::string::npos);
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
