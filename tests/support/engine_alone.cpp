#include "exitance/lab/laboratory.hpp"
#include "exitance/methods/methods.hpp"

/// The engine has neither growing cells nor published forms until the laboratory is installed.
int main() {
    using namespace exitance;
    const auto has = [](Form form, Method method) { return find_method(form, method) != nullptr; };
    const bool has_none = !has(Form::standard, Method::growing_cells) && !has(Form::published, Method::matrix);
    install_laboratory();
    return has_none && has(Form::standard, Method::growing_cells) && has(Form::published, Method::matrix) ? 0 : 1;
}
