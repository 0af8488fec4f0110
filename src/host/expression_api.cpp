// Expressions of values of robots: pogosim_expression_open() and so on of pogosim/host.h.
#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "base/floating_point.hpp"
#include "host/status.hpp"
#include "sim/condition.hpp"

using namespace pogosim;

struct pogosim_expression {
    Condition condition;
    std::string names{};  // a line for each
};

namespace {

std::vector<std::string> lines_of(char const* text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

}  // namespace

int pogosim_expression_open(char const* text, char const* known, pogosim_expression** expression) {
    *expression = nullptr;
    return with_status([&] {
        auto made = std::make_unique<pogosim_expression>(pogosim_expression{Condition(text, lines_of(known))});
        for (std::string const& name : made->condition.names()) {
            made->names += (made->names.empty() ? "" : "\n") + name;
        }
        *expression = made.release();
        return POGOSIM_OK;
    });
}

char const* pogosim_expression_names(pogosim_expression const* expression) {
    return expression->names.c_str();
}

void pogosim_expression_numbers(pogosim_expression const* expression, float const* const* values, size_t count,
                                float* numbers) {
    StandardFloatingPoint const mode;
    expression->condition.evaluate(std::span(values, expression->condition.names().size()), std::span(numbers, count));
}

void pogosim_expression_close(pogosim_expression* expression) {
    delete expression;
}
