#include "tassilo/team/topic_images.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/message/codec.h"
#include "tassilo/team/test_bus_domain.h"

namespace tassilo {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr char kTopic[] = "/camera/image_raw";

ros::Image image_at(std::int32_t second, std::uint32_t width = 8) {
  ros::Image image;
  image.header.stamp.sec = second;
  image.width = width;
  image.height = 4;
  image.encoding = "uyvy";
  image.step = 2 * width;
  image.data.assign(std::size_t{image.step} * image.height, static_cast<std::uint8_t>(second));
  return image;
}

ros::CompressedImage compressed_at(std::int32_t second, std::vector<std::uint8_t> file) {
  ros::CompressedImage image;
  image.header.stamp.sec = second;
  image.format = "bgr8; jpeg compressed bgr8";
  image.data = std::move(file);
  return image;
}

/// A driver and who listens to it, each with a bus of its own; time is the test's.
class Images : public testing::Test {
 protected:
  BusOptions options() const {
    BusOptions options;
    options.domain = domain_;
    return options;
  }

  template <Message M>
  void publish(BusReliability reliability = BusReliability::reliable) {
    BusTopic topic;
    topic.name = wire_topic_name(kTopic);
    topic.type = wire_type_name<M>();
    topic.reliability = reliability;
    topic.depth = 10;
    driver_.emplace(driver_bus_.writer(topic));
  }
  TopicImages listen() {
    TopicImagesOptions images;
    images.topic = kTopic;
    images.decode = [](std::span<const std::uint8_t> file) {
      if (file.size() != 3) throw Error("image", "is no picture");
      return make_frame_buffer(PixelFormat::yuv422p, 8, 4, ColorRange::full).frame;
    };
    return TopicImages(bus_, std::move(images));
  }
  /// Until the driver is heard.
  void meet(TopicImages& images, double now = 0) {
    const auto end = std::chrono::steady_clock::now() + 20s;
    while (driver_->readers() == 0 && std::chrono::steady_clock::now() < end) {
      EXPECT_FALSE(images.take(now));
      bus_.wait(20ms);
    }
    ASSERT_EQ(driver_->readers(), 1);
  }
  /// Sends one and gives what comes of it.
  template <Message M>
  std::optional<Frame> pass(TopicImages& images, const M& message, double now = 0) {
    return pass_bytes(images, encoded(message), now);
  }
  std::optional<Frame> pass_bytes(TopicImages& images, const std::vector<std::byte>& bytes, double now = 0) {
    driver_->write(bytes);
    const auto seen = [&] {
      const TopicImageCounts counts = images.counts();
      return counts.older + counts.refused;
    };
    const std::int64_t before = seen();
    const auto end = std::chrono::steady_clock::now() + 20s;
    while (std::chrono::steady_clock::now() < end) {
      if (auto frame = images.take(now)) return frame;
      if (seen() > before) return std::nullopt;
      bus_.wait(20ms);
    }
    ADD_FAILURE() << "nothing came";
    return std::nullopt;
  }

  int domain_ = free_domain();
  Bus driver_bus_{options()};
  Bus bus_{options()};
  std::optional<BusWriter> driver_;
};

TEST_F(Images, ComeWithStampAndPosition) {
  publish<ros::Image>();
  TopicImages images = listen();
  meet(images);
  for (int second = 10; second < 13; ++second) {
    const auto frame = pass(images, image_at(second));
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->t, second);
    EXPECT_EQ(frame->index, second - 10);
    EXPECT_EQ(frame->view.y(7, 3), second);
  }
  EXPECT_EQ(images.description(), "sensor_msgs/msg/Image, uyvy422 8x4 px, limited range");
  EXPECT_THAT(images.news(), IsEmpty());
  EXPECT_EQ(images.counts().refused, 0);
}

TEST_F(Images, OfADriverThatComesBackAndOffersLessAreHeard) {
  publish<ros::Image>(BusReliability::reliable);
  TopicImages images = listen();
  meet(images);
  ASSERT_TRUE(pass(images, image_at(10), 0));
  driver_.reset();
  publish<ros::Image>(BusReliability::best_effort);
  meet(images, 2);
  const auto frame = pass(images, image_at(12), 3);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->t, 12);
  EXPECT_EQ(frame->index, 1);
}

TEST_F(Images, OfTwoDriversAreToldOnce) {
  publish<ros::Image>();
  TopicImages images = listen();
  meet(images);
  ASSERT_TRUE(pass(images, image_at(10)));
  Bus other{options()};
  BusTopic topic;
  topic.name = wire_topic_name(kTopic);
  topic.type = wire_type_name<ros::Image>();
  topic.reliability = BusReliability::reliable;
  BusWriter second = other.writer(topic);
  const auto end = std::chrono::steady_clock::now() + 20s;
  while (second.readers() == 0 && std::chrono::steady_clock::now() < end) other.wait(20ms);
  for (int time = 11; time < 15; ++time) {
    std::swap(*driver_, second);
    ASSERT_TRUE(pass(images, image_at(time)));
  }
  EXPECT_THAT(images.news(), ElementsAre("topic /camera/image_raw has two publishers at once, whose images are mixed"));
}

TEST_F(Images, OfADriverThatComesBackWithAnotherTypeAreMissed) {
  publish<ros::Image>();
  TopicImages images = listen();
  meet(images);
  ASSERT_TRUE(pass(images, image_at(10), 0));
  driver_.reset();
  Bus other{options()};
  BusTopic topic;
  topic.name = wire_topic_name(kTopic);
  topic.type = wire_type_name<ros::CompressedImage>();
  const BusWriter writer = other.writer(topic);
  const auto end = std::chrono::steady_clock::now() + 20s;
  while (published_types(bus_, kTopic) != std::vector{topic.type} && std::chrono::steady_clock::now() < end)
    bus_.wait(20ms);
  EXPECT_FALSE(images.take(2));
  EXPECT_THAT(images.news(),
              ElementsAre(HasSubstr("it is now published as sensor_msgs/msg/CompressedImage; start again")));
  EXPECT_FALSE(images.take(3));
  EXPECT_FALSE(images.take(4));
  EXPECT_THAT(images.news(), IsEmpty());
}

TEST_F(Images, NewestWinsAndOthersAreCounted) {
  publish<ros::Image>();
  TopicImages images = listen();
  meet(images);
  ASSERT_TRUE(pass(images, image_at(10)));
  for (int second = 11; second < 20; ++second) driver_->write(encoded(image_at(second)));
  std::optional<Frame> newest;
  std::int64_t seen = 0;
  const auto end = std::chrono::steady_clock::now() + 20s;
  while ((!newest || newest->t < 19) && std::chrono::steady_clock::now() < end) {
    if (auto frame = images.take(0)) {
      newest = frame;
      ++seen;
    }
  }
  ASSERT_TRUE(newest);
  EXPECT_EQ(newest->t, 19);
  EXPECT_EQ(newest->index, 9);
  EXPECT_EQ(images.counts().missed, 9 - seen);
}

TEST_F(Images, OfAnotherSizeOrMalformedAreRefusedOnceOneWasThere) {
  publish<ros::Image>();
  TopicImages images = listen();
  meet(images);
  // Before that, too, but for an encoding that nobody knows.
  EXPECT_FALSE(pass_bytes(images, std::vector<std::byte>(12)));
  EXPECT_THAT(images.counts().last_refusal, HasSubstr("is no whole sensor_msgs/msg/Image"));
  const auto first = pass(images, image_at(10));
  ASSERT_TRUE(first);
  EXPECT_EQ(first->index, 0);
  EXPECT_FALSE(pass(images, image_at(11, 10)));
  EXPECT_THAT(images.counts().last_refusal,
              HasSubstr("has 10x4 px, limited range, must have that of the first one: 8x4 px, limited range"));
  ros::Image bad = image_at(12);
  bad.encoding = "mono8";
  EXPECT_FALSE(pass(images, bad));
  bad = image_at(12);
  bad.header.stamp.nanosec = 1'000'000'000;
  EXPECT_FALSE(pass(images, bad));
  EXPECT_THAT(images.counts().last_refusal, HasSubstr("has a stamp that is no time"));
  EXPECT_EQ(images.counts().refused, 4);
  const auto next = pass(images, image_at(12));
  ASSERT_TRUE(next);
  EXPECT_EQ(next->index, 4);
}

TEST_F(Images, OfAnUnknownEncodingEndIt) {
  publish<ros::Image>();
  TopicImages images = listen();
  meet(images);
  ros::Image bad = image_at(10);
  bad.encoding = "bayer_rggb8";
  try {
    pass(images, bad);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("topic /camera/image_raw: encoding: is bayer_rggb8, must be uyvy (yuv422)"));
  }
}

TEST_F(Images, CompressedAreDecoded) {
  publish<ros::CompressedImage>();
  TopicImages images = listen();
  meet(images);
  EXPECT_FALSE(pass(images, compressed_at(9, {1, 2})));
  const auto frame = pass(images, compressed_at(10, {1, 2, 3}));
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->t, 10);
  EXPECT_EQ(images.description(), "sensor_msgs/msg/CompressedImage, yuv422p 8x4 px, full range");
  EXPECT_EQ(images.counts().last_refusal, "image: is no picture");
}

TEST_F(Images, OfAnotherTypeAreAnError) {
  publish<ros::Odometry>();
  TopicImages images = listen();
  try {
    for (int i = 0; i < 200; ++i) {
      images.take(0);
      bus_.wait(100ms);
    }
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("topic /camera/image_raw: is published as nav_msgs/msg/Odometry, must be"));
  }
}

TEST_F(Images, WithOlderStampsAreDroppedAndEndItWhenTheyStay) {
  publish<ros::Image>();
  TopicImages images = listen();
  meet(images);
  ASSERT_TRUE(pass(images, image_at(100), 0));
  EXPECT_FALSE(pass(images, image_at(100), 0.1));
  EXPECT_FALSE(pass(images, image_at(90), 0.2));
  EXPECT_EQ(images.counts().older, 2);
  ASSERT_TRUE(pass(images, image_at(101), 0.3));
  EXPECT_FALSE(pass(images, image_at(91), 0.4));
  EXPECT_FALSE(pass(images, image_at(92), 2.3));
  try {
    pass(images, image_at(93), 2.5);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("has stamps that went back by 8.0 s and stay there"));
  }
}

TEST_F(Images, WithoutAStampAreOfTheirArrival) {
  publish<ros::Image>();
  TopicImages images = listen();
  meet(images);
  const auto frame = pass(images, image_at(0));
  ASSERT_TRUE(frame);
  const double now = std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  EXPECT_NEAR(frame->t, now, 20);
  EXPECT_EQ(images.delay_s(), 0);
}

TEST_F(Images, SilenceIsToldOnceAndItsEnd) {
  TopicImages images = listen();
  images.take(0);
  EXPECT_THAT(images.news(), IsEmpty());
  images.take(1);
  images.take(2);
  EXPECT_THAT(images.news(), ElementsAre("waiting for topic /camera/image_raw, which nobody publishes"));
  publish<ros::Image>();
  meet(images, 3);
  EXPECT_THAT(images.news(), IsEmpty());
  images.take(3.9);
  images.take(4.1);
  images.take(9);
  EXPECT_THAT(images.news(),
              ElementsAre("waiting for images of topic /camera/image_raw: it has a publisher, which sends none"));
  ASSERT_TRUE(pass(images, image_at(10), 10));
  images.take(10.9);
  EXPECT_THAT(images.news(), IsEmpty());
  images.take(11);
  images.take(12);
  EXPECT_THAT(
      images.news(),
      ElementsAre("silent: topic /camera/image_raw has sent no image for 1.0 s: it has a publisher, which sends none"));
  ASSERT_TRUE(pass(images, image_at(12), 12.5));
  EXPECT_THAT(images.news(), ElementsAre("back: topic /camera/image_raw after 2.5 s"));
  driver_.reset();
  const auto end = std::chrono::steady_clock::now() + 20s;
  while (!published_types(bus_, kTopic).empty() && std::chrono::steady_clock::now() < end) bus_.wait(20ms);
  images.take(14);
  images.take(15);
  EXPECT_THAT(images.news(),
              ElementsAre("silent: topic /camera/image_raw has sent no image for 1.5 s: nobody publishes it any more"));
  EXPECT_EQ(images.counts().silences, 2);
}

TEST(TopicNames, AreThoseOfRos) {
  for (const char* const name : {"/a", "/camera/image_raw", "/_x/Y9/z"}) EXPECT_TRUE(is_ros_topic_name(name)) << name;
  for (const char* const name : {"", "/", "a", "/a/", "//a", "/a//b", "/9", "/a/9b", "/a b", "/a-b", "/\n"})
    EXPECT_FALSE(is_ros_topic_name(name)) << name;
  EXPECT_FALSE(is_ros_topic_name("/" + std::string(300, 'a')));
  EXPECT_EQ(wire_topic_name("/odom"), "rt/odom");
  EXPECT_EQ(ros_topic_name("rt/odom"), "/odom");
  for (const char* other : {"", "rt", "rq/odom", "odom", "/odom"}) EXPECT_EQ(ros_topic_name(other), "") << other;
  EXPECT_EQ(ros_type_from_wire("sensor_msgs::msg::dds_::Image_"), "sensor_msgs/msg/Image");
  EXPECT_EQ(ros_type_from_wire("Image\33[2J"), "Image?[2J");
}

}  // namespace
}  // namespace tassilo
