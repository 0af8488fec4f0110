#include "config/object_parts.hpp"

#include <fmt/format.h>

#include <array>
#include <span>
#include <string>

namespace pogosim {

namespace {

enum class Model { constant, dynamic, realistic };

struct ModelChoice {
    Model model = Model::dynamic;
};

std::span<Key<ModelChoice> const> model_keys() {
    static std::array const keys{
        Key<ModelChoice>{
            "type",
            one_of(&ModelChoice::model,
                   {{"static", Model::constant}, {"dynamic", Model::dynamic}, {"realistic", Model::realistic}}),
            any(), "",
            "static: always `rate`. dynamic: decreases with message size m, send probability p and cluster size c. "
            "With zeta or theta, or with none of the keys below, the article's equation, 1 / (alpha + beta p^gamma "
            "c^delta exp(zeta m) + theta p c); with only some of alpha, beta, gamma, delta, the older four-parameter "
            "law, 1 / (1 + alpha m^beta p^gamma c^delta). realistic: the four-parameter law with its default "
            "parameters. Without msg_success_rate: the article's equation with its default parameters.",
            /*required=*/true},
    };
    return keys;
}

std::span<Key<ReceptionSpec> const> parameter_keys() {
    using K = Key<ReceptionSpec>;
    static ReceptionSpec const older = four_parameter_law();
    static auto const doc = [](char const* name, double of_older) {
        return fmt::format("dynamic: parameter {}; default in the four-parameter law: {}.", name, of_older);
    };
    static std::array const docs{doc("alpha", older.alpha), doc("beta", older.beta), doc("gamma", older.gamma),
                                 doc("delta", older.delta)};
    static constexpr auto has_parameters = [](ReceptionSpec const& spec) { return spec.law != ReceptionLaw::constant; };
    static constexpr auto has_six = [](ReceptionSpec const& spec) { return spec.law == ReceptionLaw::article; };
    static std::array const keys{
        K{"rate", &ReceptionSpec::rate, between(0, 1), "", "static: the probability."}.only_if(
            [](ReceptionSpec const& spec) { return spec.law == ReceptionLaw::constant; }),
        K{"alpha", &ReceptionSpec::alpha, any(), "", docs[0]}.only_if(has_parameters),
        K{"beta", &ReceptionSpec::beta, any(), "", docs[1]}.only_if(has_parameters),
        K{"gamma", &ReceptionSpec::gamma, any(), "", docs[2]}.only_if(has_parameters),
        K{"delta", &ReceptionSpec::delta, any(), "", docs[3]}.only_if(has_parameters),
        K{"zeta", &ReceptionSpec::zeta, any(), "1/byte", "dynamic: parameter zeta; selects the article's equation."}
            .only_if(has_six),
        K{"theta", &ReceptionSpec::theta, any(), "", "dynamic: parameter theta; selects the article's equation."}
            .only_if(has_six),
    };
    return keys;
}

ReceptionSpec defaults_of(Model model, MapReader const& reader) {
    auto const is_given = [&reader](char const* key) { return reader.find(key) != nullptr; };
    bool const asks_four = is_given("alpha") || is_given("beta") || is_given("gamma") || is_given("delta");
    bool const asks_six = is_given("zeta") || is_given("theta");
    if (model == Model::realistic || (model == Model::dynamic && asks_four && !asks_six)) {
        return four_parameter_law();
    }
    ReceptionSpec spec;
    spec.law = model == Model::constant ? ReceptionLaw::constant : ReceptionLaw::article;
    return spec;
}

}  // namespace

ReceptionSpec read_reception_map(MapReader& reader) {
    ModelChoice choice;
    reader.read(model_keys(), choice);
    ReceptionSpec spec = defaults_of(choice.model, reader);
    if (choice.model == Model::realistic) {
        ReceptionSpec ignored = spec;
        reader.read_unused(parameter_keys(), ignored);
        reader.note_values(parameter_keys(), spec);
    } else {
        reader.read(parameter_keys(), spec);
    }
    return spec;
}

ReceptionSpec read_reception(MapReader& robot) {
    ReceptionSpec spec;
    robot.read_map("msg_success_rate", kReceptionMap, [&](MapReader& map) {
        spec = read_reception_map(map);
        robot.set_value("msg_success_rate", map.values());  // also where the law is the default one
    });
    return spec;
}

}  // namespace pogosim
