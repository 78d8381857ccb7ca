#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "run_program.hpp"

namespace exitance::test {
namespace {

constexpr const char* downlight =
    "IESNA:LM-63-2002\n[TEST] own\n[MANUFAC] nobody\nTILT=NONE\n1 4000 1 7 1 1 2 0.6 1.2 0\n1 1 20\n"
    "0 15 30 45 60 75 90\n0\n1000 965.9 866 707.1 500 258.8 0\n";

TEST(ProgramLuminaire, TellsFactsAndDrawsThem) {
    const TemporaryFolder folder;
    write_text(folder / "d.ies", downlight);
    const Finished text = run_program({"luminaire", folder / "d.ies", "-o", folder / "d.svg", "-o", folder / "d.obj"});
    EXPECT_EQ(text.status, 0) << text.err;
    EXPECT_NE(text.out.find("beam angle (50%)"), std::string::npos) << text.out;
    EXPECT_TRUE(read_text(folder / "d.svg").starts_with("<svg"));
    const Finished checked = run_program({"check", folder / "d.obj", "--json"});
    EXPECT_EQ(checked.status, 0) << checked.err;
    const Finished json = run_program({"luminaire", folder / "d.ies", "--json"});
    const auto facts = nlohmann::json::parse(json.out);
    EXPECT_NEAR(facts["luminaire_lumens"], 3123.8, 1);
    EXPECT_NEAR(facts["efficiency"], 0.781, 1e-3);
    EXPECT_NEAR(facts["beam_angle"]["c0_c180"], 120, 0.1);
    EXPECT_EQ(facts["opening"]["shape"], "rectangle");
    EXPECT_EQ(facts["opening"]["size"], (std::vector<double>{1.2, 0.6, 0}));
}

TEST(ProgramLuminaire, SaysWhereAFileIsWrong) {
    const TemporaryFolder folder;
    std::string text = downlight;
    write_text(folder / "d.ies", text.replace(text.find("707.1"), 5, "7o7.1"));
    const Finished bad = run_program({"luminaire", folder / "d.ies"});
    EXPECT_EQ(bad.status, 3);
    EXPECT_NE(bad.err.find("d.ies:9: '7o7.1'"), std::string::npos) << bad.err;
    EXPECT_EQ(run_program({"luminaire", folder / "d.xyz"}).status, 3);
    EXPECT_EQ(run_program({"luminaire", folder / "d.ies", "-o", "a.png"}).status, 2);
}

}  // namespace
}  // namespace exitance::test
