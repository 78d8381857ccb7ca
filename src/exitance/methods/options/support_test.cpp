#include "exitance/methods/options/support.hpp"

#include <gtest/gtest.h>

#include "exitance/methods/options/make_request.hpp"
#include "exitance/methods/options/recipes.hpp"
#include "exitance/methods/options/solve_option_table.hpp"
#include "exitance/methods/plan/choice.hpp"
#include "support/built_scene.hpp"
#include "support/option_words.hpp"

namespace exitance {
namespace {

SolveOptions by(Method method, SolveOptions options) {
    options.method = method;
    return options;
}

GivenOption given(const char* name, std::string word = "") {
    const OptionRow* const row = find_option(name);
    EXI_CHECK(row);
    return {row, std::move(word)};
}

std::string error_of(const std::vector<GivenOption>& options) {
    const Result<SolveRequest> request = make_request(options);
    if (!request) return request.error().where + ": " + request.error().message;
    const Result<MethodForm> method_form = find_method_form(*request);
    return method_form ? "" : method_form.error().message;
}

TEST(OptionTable, NamesAreUniqueAndEveryRowIsComplete) {
    std::vector<std::string> names;
    for (const OptionRow& row : solve_option_table()) {
        EXPECT_TRUE(row.name.starts_with("--"));
        EXPECT_TRUE(row.value.read && row.value.word && row.value.json) << row.name;
        EXPECT_FALSE(row.does.empty() || row.does.ends_with('.')) << row.name << ": help_of() ends the sentence";
        EXPECT_FALSE(row.group.title.empty()) << row.name;
        EXPECT_EQ(std::count(names.begin(), names.end(), row.name), 0) << row.name;
        names.push_back(row.name);
        for (const auto* rules : {&row.needs, &row.excludes})
            for (const OptionRule& rule : *rules)
                EXPECT_TRUE(find_option(rule.other.substr(0, rule.other.find(' ')))) << rule.other;
    }
}

TEST(OptionTable, AWordThatIsReadIsTheWordInForce) {
    for (const OptionRow& row : solve_option_table())
        for (const std::string& word : test::words_for(row)) {
            SolveRequest request;
            EXPECT_FALSE(row.value.word(request)) << row.name << " is set before it is read";
            EXPECT_EQ(row.value.read(word, request), "") << row.name << " " << word;
            if (const auto now = row.value.word(request); now && !row.value.type.empty() && row.name != "--snapshots") {
                EXPECT_EQ(*now, row.name == "--memory-limit" ? "4194304" : word) << row.name;
            }
        }
}

TEST(OptionSupport, EveryMethodRefusesWhatItDoesNotSupportAndNamesTheMethodsThatDo) {
    std::size_t refused = 0;
    for (const OptionRow& row : solve_option_table())
        for (const std::string& word : test::words_for(row))
            for (const auto& [method, name] : method_names) {
                if (method == Method::automatic || row.name == "--method" || row.name == "--recipe") continue;
                SolveRequest request{.options = {.method = method}};
                ASSERT_EQ(row.value.read(word, request), "");
                settle(request);
                if (!row.value.word(request)) continue;
                const Form form = form_of(request.options);
                const bool counts = request.options.bounces > 0 && method != Method::discontinuity;
                const MethodForm method_form{form, counts && form == Form::standard ? Method::matrix : method};
                if (supports(row, request, method_form)) continue;
                ++refused;
                const Result<MethodForm> found = find_method_form(request);
                ASSERT_FALSE(found) << row.name << " " << word << " " << name;
                EXPECT_EQ(found.error().code, ErrorCode::usage);
                EXPECT_NE(found.error().message.find(row.name), std::string::npos) << found.error().message;
                EXPECT_FALSE(found.error().hint.empty()) << found.error().message;
                for (const auto& [other, other_name] : method_names) {
                    SolveRequest by_other = request;
                    by_other.options.method = other;
                    if (other == Method::automatic || !supports(row, by_other, {form, other})) continue;
                    EXPECT_NE(found.error().message.find(other_name), std::string::npos) << found.error().message;
                }
            }
    EXPECT_GT(refused, 300u);
}

TEST(OptionSupport, MessagesSayWhatIsWrongAndWhatSupportsIt) {
    EXPECT_EQ(
        error_of({given("--method", "progressive"), given("--clusters", "on")}),
        "--clusters is not supported by --method progressive (supported by hierarchical, wavelet, discontinuity)");
    EXPECT_EQ(
        error_of({given("--method", "matrix"), given("--epsilon", "0.1")}),
        "--epsilon is not supported by --method matrix (supported by hierarchical, wavelet, discontinuity; matrix "
        "with --basis galerkin1 to galerkin3)");
    EXPECT_EQ(error_of({given("--gather", "off"), given("--keep-links")}),
              "--keep-links cannot be combined with --gather, which selects the method's published form");
    EXPECT_EQ(error_of({given("--ambient"), given("--multigrid", "3")}),
              "no method supports both --multigrid and --ambient");
    EXPECT_EQ(error_of({given("--sor-factor", "1.5")}), "--sor-factor needs --relaxation sor");
    EXPECT_EQ(error_of({given("--light-groups"), given("--resume")}),
              "--light-groups cannot be combined with --resume");
    EXPECT_EQ(error_of({given("--recipe", "hanrahan9")}),
              "--recipe: there is no recipe 'hanrahan9'; did you mean hanrahan91?");
}

TEST(OptionSupport, RefusesCombinationsWithinAMethod) {
    const std::pair<SolveOptions, Method> refused[] = {
        {{.epsilon = 0.01, .relaxation = Relaxation::cg}, Method::hierarchical},
        {{.basis = BasisKind::linear, .form_factors = FormFactorKind::hemicube}, Method::matrix},
    };
    for (const auto& [options, method] : refused) {
        EXPECT_FALSE(find_method_form({.options = by(method, options)}));
        EXPECT_FALSE(supports_all(method, options));
    }
}

TEST(OptionSupport, TakesWhatAMethodSupports) {
    const std::pair<SolveOptions, Method> taken[] = {
        {{}, Method::growing_cells},
        {{.epsilon = 0.01, .relaxation = Relaxation::chebyshev}, Method::wavelet},
        {{.relaxation = Relaxation::cg}, Method::hierarchical},
        {{.relaxation = Relaxation::southwell, .overshooting = true}, Method::progressive},
        {{.relaxation = Relaxation::jacobi}, Method::monte_carlo},
        {{.visibility_samples = 4, .form_factors = FormFactorKind::analytic}, Method::matrix},
        {{.basis = BasisKind::galerkin2, .epsilon = 0.01, .triage = false}, Method::matrix},
        // accepted, since `matrix` replaces the method
        {{.bounces = 2, .relaxation = Relaxation::cg}, Method::wavelet},
        {{.keep_links = true}, Method::discontinuity},
    };
    for (const auto& [options, method] : taken)
        EXPECT_TRUE(find_method_form({.options = by(method, options)})) << name_in(method_names, method);
}

TEST(OptionSupport, AutomaticIsTheFirstMethodThatSupportsAll) {
    const Scene tube = built_scene("tube"), cornell = built_scene("cornell");
    const Stage open(tube), cluttered(cornell);
    const auto chosen = [](const Stage& stage, const SolveOptions& options) {
        EXPECT_TRUE(find_method_form({.options = options}));
        return choose_method(stage, options).options.method;
    };
    EXPECT_EQ(chosen(cluttered, {.overshooting = true}), Method::progressive);
    EXPECT_EQ(chosen(cluttered, {.epsilon = 0.01}), Method::hierarchical);
    EXPECT_EQ(chosen(open, {.error = 0.001}), Method::wavelet);
    EXPECT_EQ(chosen(open, {.error = 0.001, .form_factors = FormFactorKind::hemicube}), Method::matrix);
    EXPECT_EQ(chosen(cluttered, {.basis = BasisKind::linear, .error_interpolant = 0.001}), Method::matrix);
    EXPECT_FALSE(find_method_form({.options = {.epsilon = 0.01, .overshooting = true}}));
    EXPECT_FALSE(find_method_form({.options = {.hemicube_cells = 16}}));
    const auto method_form = [](const std::vector<GivenOption>& options) {
        return *find_method_form(*make_request(options));
    };
    EXPECT_EQ(method_form({given("--dm-sources", "3")}).method, Method::discontinuity);
    EXPECT_EQ(method_form({given("--max-units", "64")}).method, Method::growing_cells);
    EXPECT_EQ(method_form({given("--local-pass", "a")}).form, Form::local_passes);
    EXPECT_EQ(method_form({given("--task-engine")}).method, Method::hierarchical);
}

TEST(OptionSupport, PublishedFormsNameTheMethodsThatSupportAnOption) {
    ClassicalOptions c;
    c.gather = false;
    EXPECT_FALSE(find_method_form({.options = {.method = Method::monte_carlo, .classical = c}}));
    EXPECT_FALSE(
        find_method_form({.options = {.method = Method::wavelet, .oracle = LinkOracle::power, .classical = c}}));
    c.ambient = true;
    const Result<MethodForm> wrong = find_method_form({.options = {.method = Method::matrix, .classical = c}});
    ASSERT_FALSE(wrong);
    EXPECT_NE(wrong.error().message.find("progressive, substructuring"), std::string::npos) << wrong.error().message;
    EXPECT_EQ(find_method_form({.options = {.classical = c}})->method, Method::progressive);
}

TEST(Recipes, PresetOptionsThatTheirMethodSupports) {
    for (const Recipe& recipe : recipes()) {
        EXPECT_EQ(error_of({given("--recipe", std::string(recipe.name))}), "") << recipe.name;
        EXPECT_EQ(nearest_recipe(recipe.name), recipe.name);
    }
}

TEST(Recipes, GivenOptionsReplacePresetsWhereverTheyStand) {
    const Result<SolveRequest> request = make_request(
        std::vector{given("--threshold", "0.5"), given("--recipe", "hanrahan91"), given("--output-light", "gathered")});
    ASSERT_TRUE(request);
    EXPECT_EQ(request->options.classical.threshold, 0.5);
    EXPECT_EQ(request->options.classical.gather, true);
    EXPECT_EQ(request->options.oracle, LinkOracle::power);
    EXPECT_NE(error_of({given("--recipe", "hanrahan91"), given("--method", "wavelet")}), "");
}

TEST(OldNames, MeanWhatTheirWarningsSay) {
    const auto request = [](const std::vector<GivenOption>& options) { return *make_request(options); };
    const SolveRequest raw = request({given("--method", "matrix"), given("--gather", "off")});
    ASSERT_EQ(raw.warnings.size(), 1u);
    EXPECT_EQ(raw.warnings[0], "--gather off will be removed in 0.4: use --recipe classical-matrix");
    const SolveRequest recipe = request({given("--recipe", "classical-matrix")});
    EXPECT_EQ(recipe.options.classical.gather, raw.options.classical.gather);
    EXPECT_EQ(recipe.options.method, raw.options.method);
    EXPECT_EQ(form_of(recipe.options), form_of(raw.options));
    EXPECT_TRUE(recipe.warnings.empty());
    for (const auto& [word, light] : {std::pair{"off", "elements"}, {"on", "smoothed-elements"}}) {
        const SolveRequest old = request({given("--smoothing", word)});
        EXPECT_EQ(old.warnings.at(0),
                  std::string("--smoothing ") + word + " will be removed in 0.4: use --output-light " + light);
        EXPECT_EQ(old.options.smoothing, request({given("--output-light", light)}).options.smoothing);
    }
    EXPECT_NE(error_of({given("--output-light", "elements"), given("--gather", "off")}), "");
}

}  // namespace
}  // namespace exitance
