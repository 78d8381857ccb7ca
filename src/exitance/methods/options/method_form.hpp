#pragma once

#include <cstdint>
#include <initializer_list>

#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// The pipeline that a solve runs through.
enum class Form : std::uint8_t {
    standard,     ///< Exact direct light, a method, a final gather, an error estimate.
    published,    ///< The method as its paper describes it (docs/laboratory/recipes.md).
    tasks,        ///< Hierarchical radiosity as tasks that create tasks (docs/methods/tasks.md).
    local_passes  ///< Discontinuity meshing with local pass a to d (docs/methods/local_passes.md).
};

/// A method in one of its forms.
struct MethodForm {
    Form form;
    Method method;
};

/// A set of methods in their forms.
class MethodForms {
  public:
    constexpr MethodForms() = default;
    constexpr MethodForms(Form form, std::initializer_list<Method> methods) {
        for (const Method method : methods) bits_ |= bit({form, method});
    }

    constexpr bool contains(MethodForm method_form) const { return (bits_ & bit(method_form)) != 0; }
    constexpr bool empty() const { return bits_ == 0; }
    friend constexpr MethodForms operator|(MethodForms a, MethodForms b) {
        a.bits_ |= b.bits_;
        return a;
    }

  private:
    static constexpr std::uint64_t bit(MethodForm method_form) {
        return std::uint64_t(1) << (16 * static_cast<unsigned>(method_form.form) +
                                    static_cast<unsigned>(method_form.method));
    }

    std::uint64_t bits_ = 0;
};

}  // namespace exitance
