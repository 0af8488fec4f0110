// USERDATA of C++, for tests/robot/program_variables_test.cpp, which reads them as the window does.
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

struct Origin {
    float depth = 0.5F;
};

struct Base : Origin {
    int32_t id = 3;
};

struct Root {
    int32_t root = 7;
};

struct Polymorphic : virtual Root {
    virtual ~Polymorphic() = default;
    int16_t own = 12;
};

struct Data : Base {
    uint32_t count = 9;
    std::array<int32_t, 2> numbers{4, 5};
    std::vector<int> list;
    Polymorphic part;
    unsigned low : 3 = 5;
    static inline int32_t total = 8;
};

__attribute__((used)) static Data const* const pogo_user_data_type = nullptr;  // as REGISTER_USERDATA has it

extern "C" {
Data example;
extern std::size_t const size_of_data;
std::size_t const size_of_data = sizeof(Data);
}
