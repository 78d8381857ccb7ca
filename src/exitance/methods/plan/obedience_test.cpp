#include "exitance/methods/plan/obedience.hpp"

#include <gtest/gtest.h>

#include "exitance/methods/plan/choice.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

SolveOptions by(Method method, SolveOptions options) {
    options.method = method;
    return options;
}

TEST(Obedience, RejectsUnsupportedOptionsAndListsSupportingMethods) {
    const std::pair<SolveOptions, Method> refused[] = {
        {{.epsilon = 0.01}, Method::progressive},
        {{.epsilon = 0.01}, Method::matrix},
        {{.overshooting = true}, Method::matrix},
        {{.overshooting = true}, Method::wavelet},
        {{.relaxation = Relaxation::cg}, Method::substructuring},
        {{.epsilon = 0.01, .relaxation = Relaxation::cg}, Method::hierarchical},
        {{.visibility = VisibilityKind::quadrature}, Method::progressive},
        {{.visibility_samples = 4}, Method::matrix},
        {{.visibility_samples = 4}, Method::hierarchical},
        {{.triage = false}, Method::matrix},
        {{.clusters = true}, Method::monte_carlo},
        {{.basis = BasisKind::linear, .form_factors = FormFactorKind::hemicube}, Method::matrix},
        {{.form_factors = FormFactorKind::hemicube}, Method::wavelet},
        {{.oracle = LinkOracle::power}, Method::matrix},
        {{.keep_links = true}, Method::progressive},
    };
    for (const auto& [options, method] : refused) {
        const Result<void> checked = check_obedience(by(method, options));
        ASSERT_FALSE(checked) << name_in(method_names, method);
        EXPECT_EQ(checked.error().code, ErrorCode::usage);
        EXPECT_FALSE(obeys_all(method, options));
        const AskedOption asked = asked_of_methods(options).back();
        EXPECT_TRUE(checked.error().where.starts_with("--"));
        for (Method m : asked.methods)
            EXPECT_NE(checked.error().message.find(name_in(method_names, m)), std::string::npos)
                << checked.error().message;
    }
}

TEST(Obedience, AcceptsSupportedOptions) {
    const std::pair<SolveOptions, Method> taken[] = {
        {{}, Method::growing_cells},
        {{.epsilon = 0.01, .relaxation = Relaxation::chebyshev}, Method::wavelet},
        {{.relaxation = Relaxation::cg}, Method::hierarchical},
        {{.relaxation = Relaxation::southwell, .overshooting = true}, Method::progressive},
        {{.relaxation = Relaxation::jacobi}, Method::monte_carlo},
        {{.visibility_samples = 4, .form_factors = FormFactorKind::analytic}, Method::matrix},
        {{.basis = BasisKind::galerkin2, .epsilon = 0.01, .triage = false}, Method::matrix},
        {{.bounces = 2, .relaxation = Relaxation::cg}, Method::wavelet},  // matrix replaces wavelet
        {{.keep_links = true}, Method::discontinuity},
    };
    for (const auto& [options, method] : taken)
        EXPECT_TRUE(check_obedience(by(method, options))) << name_in(method_names, method);
}

TEST(Obedience, AutomaticIsTheFirstMethodThatSupportsAllOptions) {
    const Scene tube = built_scene("tube"), cornell = built_scene("cornell");
    const Stage open(tube), cluttered(cornell);
    const auto chosen = [](const Stage& stage, const SolveOptions& options) {
        EXPECT_TRUE(check_obedience(options));
        return choose_method(stage, options).options.method;
    };
    EXPECT_EQ(chosen(cluttered, {.overshooting = true}), Method::progressive);
    EXPECT_EQ(chosen(cluttered, {.epsilon = 0.01}), Method::hierarchical);
    EXPECT_EQ(chosen(open, {.error = 0.001}), Method::wavelet);
    EXPECT_EQ(chosen(open, {.error = 0.001, .form_factors = FormFactorKind::hemicube}), Method::matrix);
    EXPECT_EQ(chosen(cluttered, {.basis = BasisKind::linear, .error_interpolant = 0.001}), Method::matrix);
    EXPECT_FALSE(check_obedience({.epsilon = 0.01, .overshooting = true}));
    EXPECT_FALSE(check_obedience({.hemicube_cells = 16}));
}

}  // namespace
}  // namespace exitance
