// Robots that a host drives by arrays: the whole category at a time, without a call for each robot. Between two steps
// the host writes powers, colours and messages, and reads sensors and received messages; nothing is copied, and no step
// allocates memory.
//
// A robot takes what the arrays say at its own ticks, every 16 ms of its clock, as a program would: what is
// written twice between two of its ticks counts once, and sensors are those of its last tick.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "brain/brain.hpp"
#include "brain/driving.hpp"

namespace pogosim {

class HostBrain final : public Brain {
public:
    /// What the host writes. Shape: one entry per robot of the category.
    struct Inputs {
        /// Powers of the right, the left and the back motor, -1023 to 1023, beyond which they are cut, with a warning;
        /// positive is forward. Until one is not 0, the motors of this robot leave it alone.
        std::vector<std::array<std::int32_t, kMotorCount>> motors;
        std::vector<Leds> leds;  // head, front, right, back, left
        std::vector<std::array<std::byte, kMostPayloadBytes>> send_bytes;
        /// Bytes of a message to send, 0 to 382; negative: none. Set back to -1 by the tick that sends it. Longer
        /// messages are cut to 382 bytes, with a warning.
        std::vector<std::int32_t> send_length;
        std::vector<std::int8_t> send_face;  // 0 front, 1 right, 2 back, 3 left; others: all (-1 without a warning)
    };

    /// What the host reads, as of each robot's last tick.
    struct Outputs {
        std::vector<std::array<std::int16_t, kPhotosensorCount>> photosensors;  // back, front left, front right
        std::vector<std::array<float, 3>> acceleration;                         // as pogobot_imu_read() gives it: m/s2
        std::vector<std::array<float, 3>> angular_velocity;                     // rad/s
        std::vector<std::int16_t> battery_mv;
        std::vector<std::uint32_t> received_count;  // messages since clear_received()
    };

    /// A received message. All members have the same type, so that hosts see a table.
    struct Received {
        std::int32_t robot = 0;   // index within the category
        std::int32_t sender = 0;  // id on the air; 255 for a short message
        std::int32_t face = 0;    // that received it: 0 front, 1 right, 2 back, 3 left
        std::int32_t length = 0;  // bytes of its payload
        std::int32_t offset = 0;  // of its payload in received_bytes()
    };

    /// Drives these robots, which are all those of the category of this name that the host drives. `world` outlives
    /// this. Throws std::bad_alloc.
    HostBrain(World& world, std::string_view category, RobotRange robots);

    bool run_step() override;
    void append_state(std::vector<std::byte>& bytes) const override;
    void take_state(std::span<std::byte const>& bytes) override;

    std::string const& category() const { return category_; }
    RobotRange robots() const { return range_; }
    Inputs& inputs() { return inputs_; }
    Outputs const& outputs() const { return outputs_; }

    /// Received messages since clear_received(), robot by robot and oldest first within each step. There is room for as
    /// many as fit in all mailboxes of the category, up to 2 GiB; then they wait in there, and are lost when these are
    /// full.
    std::span<Received const> received() const { return {received_.get(), received_count_}; }
    std::span<std::byte const> received_bytes() const { return {received_bytes_.get(), used_bytes_}; }
    void clear_received();

private:
    /// Values that the host writes beyond what a robot takes, each warned of once.
    enum class TooMuch { power, length, face, face_of_model, motor };

    void expect(RobotRange robots);
    void tick(std::uint32_t robot);
    void set_motors(std::uint32_t robot, std::array<std::int32_t, kMotorCount> const& powers);
    void send(std::uint32_t robot);
    /// `what`: "motors[3, 0] is 5000, expected ...".
    void warn_once(TooMuch which, std::string_view what);
    void read_sensors(std::uint32_t robot);
    void take_messages(std::uint32_t robot);
    /// Calls visit(span) for each array of the state: numbers of entries before what they count.
    template <class Self, class Visit>
    static void visit_state(Self& brain, Visit const& visit);

    World& world_;
    std::string category_;
    RobotRange range_;
    std::array<bool, 5> warned_{};  // of a TooMuch
    Inputs inputs_;
    Outputs outputs_;
    std::vector<std::array<std::size_t, kPhotosensorCount>> light_cells_;  // of the robots that are due, see expect()
    std::size_t most_received_ = 0;
    std::size_t received_count_ = 0;
    std::size_t used_bytes_ = 0;
    std::unique_ptr<Received[]> received_;
    std::unique_ptr<std::byte[]> received_bytes_;
};

}  // namespace pogosim
