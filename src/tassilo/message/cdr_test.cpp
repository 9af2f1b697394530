#include "tassilo/message/cdr.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tassilo/message/codec.h"
#include "tassilo/message/topics.h"

namespace tassilo {
namespace {

/// Fills every field of a message at random; lists have up to five elements.
class Filler {
 public:
  explicit Filler(unsigned seed) : random_(seed) {}
  template <class T>
  void operator()(std::string_view, T& value) {
    fill(value);
  }

 private:
  template <class T>
  void fill(T& value) {
    if constexpr (Message<T>) {
      T::fields(value, *this);
    } else if constexpr (std::is_same_v<T, bool>) {
      value = random_() % 2 == 1;
    } else if constexpr (std::is_floating_point_v<T>) {
      value = std::normal_distribution<T>(0, 1000)(random_);
    } else {
      value = static_cast<T>(random_());
    }
  }
  void fill(std::string& text) {
    text.resize(random_() % 9);
    for (char& c : text) c = static_cast<char>('a' + random_() % 26);
  }
  template <class T>
  void fill(std::vector<T>& values) {
    values.resize(random_() % 6);
    for (T& value : values) fill(value);
  }
  template <class T, std::size_t n>
  void fill(std::array<T, n>& values) {
    for (T& value : values) fill(value);
  }
  std::mt19937 random_;
};

template <class M>
M random_message(unsigned seed) {
  M message;
  Filler fill(seed);
  M::fields(message, fill);
  return message;
}

template <class M>
class EveryMessage : public testing::Test {};
using Messages = testing::Types<ros::PoseWithCovarianceStamped, ros::Odometry, ros::LaserScan, ros::CompressedImage,
                                ros::Image, ros::CameraInfo, ros::TFMessage, msgs::BallArray, msgs::GoalArray,
                                msgs::RobotArray, msgs::LineArray, msgs::FreeSpace, msgs::TrackArray, msgs::TeamState>;
TYPED_TEST_SUITE(EveryMessage, Messages);

TYPED_TEST(EveryMessage, ComesBackAsItWent) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const std::vector<std::byte> bytes = encoded(random_message<TypeParam>(seed));
    const auto back = decoded<TypeParam>(bytes);
    ASSERT_TRUE(back.has_value()) << seed;
    EXPECT_EQ(encoded(*back), bytes) << seed;
  }
}

TYPED_TEST(EveryMessage, IsNothingWhenCutShort) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const std::vector<std::byte> bytes = encoded(random_message<TypeParam>(seed));
    for (std::size_t size = 0; size < bytes.size(); ++size)
      EXPECT_FALSE(decoded<TypeParam>(std::span(bytes).first(size)).has_value()) << seed << ", " << size;
  }
}

TYPED_TEST(EveryMessage, IsNothingWithMoreThanPaddingBehindIt) {
  std::vector<std::byte> bytes = encoded(random_message<TypeParam>(1));
  for (int padding = 0; padding < 3; ++padding) {
    bytes.push_back({});
    EXPECT_TRUE(decoded<TypeParam>(bytes).has_value()) << padding;
  }
  bytes.push_back({});
  EXPECT_FALSE(decoded<TypeParam>(bytes).has_value());
}

TYPED_TEST(EveryMessage, SurvivesAnyBytes) {
  std::mt19937 random(7);
  for (unsigned round = 0; round < 2000; ++round) {
    std::vector<std::byte> bytes = encoded(random_message<TypeParam>(round % 10));
    for (int k = 0; k < 4; ++k) bytes[random() % bytes.size()] = static_cast<std::byte>(random());
    const auto back = decoded<TypeParam>(bytes);
    if (back) {
      EXPECT_LE(encoded(*back).size(), bytes.size() + 3);
    }
  }
}

std::vector<std::byte> bytes_of(std::initializer_list<int> values) {
  std::vector<std::byte> bytes;
  for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

TEST(Cdr, IsAsTheStandardSays) {
  // By hand after DDSI-RTPS: numbers aligned to their size behind the encapsulation, strings with length and end.
  ros::CompressedImage image;
  image.header = {{1, 0x02030405}, "ab"};
  image.format = "jpeg";
  image.data = {9, 8};
  EXPECT_EQ(encoded(image), bytes_of({0, 1, 0, 0,                                  //
                                      1, 0, 0, 0, 5,   4,   3,   2,                // stamp
                                      3, 0, 0, 0, 'a', 'b', 0,   0,                // frame_id, then filled to 4
                                      5, 0, 0, 0, 'j', 'p', 'e', 'g', 0, 0, 0, 0,  // format
                                      2, 0, 0, 0, 9,   8}));
}

TEST(Cdr, EmptyListsOfLargeNumbersAreNotAligned) {
  msgs::FreeSpace space;  // float32[] and uint8[], behind four numbers of eight bytes
  ros::CameraInfo info;
  info.d = {};
  const std::size_t without = encoded(info).size();
  info.d = {1};
  EXPECT_GT(encoded(info).size(), without);
  ASSERT_TRUE(decoded<ros::CameraInfo>(encoded(info)));
  EXPECT_EQ(decoded<ros::CameraInfo>(encoded(info))->d, std::vector<double>{1});
}

TEST(Cdr, BigEndianIsReadToo) {
  std::vector<std::byte> bytes =
      bytes_of({0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 4, 5, 0, 0, 0, 2, 'a', 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1});
  const auto image = decoded<ros::CompressedImage>(bytes);
  EXPECT_FALSE(image);  // a string of length 1 without its end
  bytes = bytes_of(
      {0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 4, 5, 0, 0, 0, 2, 'a', 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 2, 7, 6});
  const auto read = decoded<ros::CompressedImage>(bytes);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->header.stamp.nanosec, 0x02030405U);
  EXPECT_EQ(read->header.frame_id, "a");
  EXPECT_EQ(read->data, (std::vector<std::uint8_t>{7, 6}));
}

TEST(Cdr, ACountIsNotBelieved) {
  // 2^32 - 1 transforms in no bytes: neither waits nor takes memory.
  const auto bytes = bytes_of({0, 1, 0, 0, 0xff, 0xff, 0xff, 0xff});
  EXPECT_FALSE(decoded<ros::TFMessage>(bytes));
}

TEST(Cdr, OtherEncapsulationsAreNothing) {
  std::vector<std::byte> bytes = encoded(ros::TFMessage{});
  for (int kind = 2; kind < 256; ++kind) {
    bytes[1] = static_cast<std::byte>(kind);
    EXPECT_FALSE(decoded<ros::TFMessage>(bytes)) << kind;
  }
}

}  // namespace
}  // namespace tassilo
