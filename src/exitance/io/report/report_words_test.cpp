#include "exitance/io/report/report_words.hpp"

#include <gtest/gtest.h>

#include "run_program.hpp"

namespace exitance {
namespace {

Result<ReportWords> from_file(const TemporaryFolder& folder, const std::string& toml) {
    test::write_text(folder / "words.toml", toml);
    return ReportWords::load(folder / "words.toml");
}

}  // namespace

TEST(ReportWords, WithoutATemplateAPageIsEnglishAndWhole) {
    const ReportWords english;
    EXPECT_FALSE(english.translates());
    EXPECT_TRUE(english.sections().empty());
    EXPECT_EQ(english.text("Energy balance"), "Energy balance");
    EXPECT_EQ(english.text("0.5"), "0.5");
}

TEST(ReportWords, SentencesWithNumbersAndNamesAreTranslatedAroundThem) {
    const Result<ReportWords> german = ReportWords::load("german");
    ASSERT_TRUE(german) << german.error().message;
    EXPECT_EQ(german->language(), "de");
    EXPECT_EQ(german->text("Energy balance"), "Energiebilanz");
    EXPECT_EQ(german->text("306 smaller surfaces are not listed."), "306 kleinere Flächen sind nicht aufgeführt.");
    EXPECT_EQ(german->text("0.0024% of the emitted power"), "0,0024% der abgegebenen Leistung");
    EXPECT_EQ(german->text("room 2 (kitchen), looking +x"), "Raum 2 (kitchen), Blick nach +x");
    EXPECT_EQ(german->text("Plane 3: room 2 (kitchen)"), "Messfläche 3: Raum 2 (kitchen)");
    EXPECT_EQ(german->text("1.5, -2, 1.2"), "1,5; -2; 1,2");
    EXPECT_EQ(german->text("at least 500 lx"), "mindestens 500 lx");
    EXPECT_EQ(german->text("looking -y"), "Blick nach -y");
    EXPECT_EQ(german->text("Plane 1: 0.75 m above room 2"), "Messfläche 1: 0,75 m über Raum 2");
    EXPECT_EQ(german->text("Made by exitance 0.3.0."), "Erstellt mit exitance 0.3.0.");
    EXPECT_EQ(german->text("office.v2.obj"), "office.v2.obj");
}

TEST(ReportWords, TranslatesTextsOfAPageButNoScriptsAndStyles) {
    const ReportWords german = *ReportWords::load("german");
    const std::string page =
        "<style>.Light { }</style><h2>Energy balance</h2><p> Mean E<sub>m</sub> </p><script>x = '<p>Light</p>';"
        "</script><td>0.5</td><img src=\"a\" alt=\"Illuminance in lx\" width=\"1\">";
    EXPECT_EQ(german.page(page),
              "<style>.Light { }</style><h2>Energiebilanz</h2><p> Mittel E<sub>m</sub> </p><script>x = "
              "'<p>Light</p>';</script><td>0,5</td><img src=\"a\" alt=\"Beleuchtungsstärke in lx\" width=\"1\">");
}

TEST(ReportWords, MistakesInATemplateAreNamedWithTheirLine) {
    const TemporaryFolder folder;
    const Result<ReportWords> order = from_file(folder, "sections = [\"pictures\", \"rooms\"]\n");
    ASSERT_TRUE(order);
    EXPECT_EQ(order->sections(), (std::vector<std::string>{"pictures", "rooms"}));
    EXPECT_FALSE(order->translates());
    const Result<ReportWords> section = from_file(folder, "sections = [\"cellar\"]\n");
    ASSERT_FALSE(section);
    EXPECT_NE(section.error().message.find("no section 'cellar'"), std::string::npos);
    EXPECT_NE(section.error().where.find("words.toml:1"), std::string::npos);
    const Result<ReportWords> gaps = from_file(folder, "[words]\n\"{} of {}\" = \"{} von\"\n");
    ASSERT_FALSE(gaps);
    EXPECT_NE(gaps.error().message.find("another number of {}"), std::string::npos);
    EXPECT_FALSE(from_file(folder, "langauge = \"de\"\n"));
    EXPECT_FALSE(ReportWords::load(folder / "absent.toml"));
}

}  // namespace exitance
