#include "config/reception_keys.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace pogosim {

namespace {

enum class Model { constant, dynamic, realistic };

struct ModelChoice {
    Model model = Model::realistic;
};

std::span<Key<ModelChoice> const> model_keys() {
    static std::array const keys{
        Key<ModelChoice>{
            "type",
            one_of(&ModelChoice::model,
                   {{"static", Model::constant}, {"dynamic", Model::dynamic}, {"realistic", Model::realistic}}),
            any(), "",
            "static: always `rate`. dynamic: falls with message size m, send probability p and cluster size c; with "
            "zeta or theta, or without any of the keys below, 1 / (alpha + beta p^gamma c^delta exp(zeta m) + "
            "theta p c), else 1 / (1 + alpha m^beta p^gamma c^delta). realistic: the latter with its defaults.",
            /*required=*/true},
    };
    return keys;
}

std::span<Key<ReceptionSpec> const> parameter_keys() {
    using K = Key<ReceptionSpec>;
    static std::array const keys{
        K{"rate", &ReceptionSpec::rate, between(0, 1), "", "static: the probability."},
        K{"alpha", &ReceptionSpec::alpha, any(), "", "dynamic; with zeta or theta: 1.03215183."},
        K{"beta", &ReceptionSpec::beta, any(), "", "dynamic; with zeta or theta: 0.00073859."},
        K{"gamma", &ReceptionSpec::gamma, any(), "", "dynamic; with zeta or theta: 3.14782227."},
        K{"delta", &ReceptionSpec::delta, any(), "", "dynamic; with zeta or theta: 3.52543753."},
        K{"zeta", &ReceptionSpec::zeta, any(), "1/byte", "dynamic: chooses the law with the exponential."},
        K{"theta", &ReceptionSpec::theta, any(), "", "dynamic: chooses the law with the exponential."},
    };
    return keys;
}

ReceptionSpec four_parameter_law() {
    ReceptionSpec spec;
    spec.law = ReceptionLaw::power;
    spec.alpha = 4.0e-6;
    spec.beta = 2.8096;
    spec.gamma = 2.3807;
    spec.delta = 1.2457;
    return spec;
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
    reader.read(parameter_keys(), spec);
    return choice.model == Model::realistic ? four_parameter_law() : spec;
}

ReceptionSpec read_reception(MapReader const& robot) {
    Node const* map = robot.find("msg_success_rate");
    if (map == nullptr) {
        return four_parameter_law();
    }
    MapReader reader(*map, robot.path_of("msg_success_rate"), robot.is_strict());
    ReceptionSpec const spec = read_reception_map(reader);
    reader.finish();
    return spec;
}

}  // namespace pogosim
