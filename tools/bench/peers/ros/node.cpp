// Supervisor and component of the benchmark in C++ on roscpp; the same work as tools/bench/supervise.py and component.py.
//
//   node INDEX COMPONENTS STAGES READS PADDING_BYTES LAST_WARM_UP_TICK FOLDER     (INDEX -1: the supervisor)

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/Sample.h"
#include "bench/Signal.h"

namespace {

constexpr int kQueue = 1000;
constexpr int64_t kStop = -1;
constexpr int kWarmUpTicks = 20;
constexpr int64_t kWarmUpUs = 1000000;
constexpr double kRepeatS = 0.005;
constexpr double kRepeatMaxS = 0.2;
constexpr int64_t kGiveUpUs = 80000000;

struct Shape {
  int index, components, stages, reads, padding;
  int64_t last_warm_up_tick;
  std::string folder;

  int stage(int component) const { return component % stages; }
  std::vector<int> sources() const {
    std::vector<int> made;
    for (int back = 0; back < std::min(reads, components - 1); ++back)
      made.push_back(((index - 1 - back) % components + components) % components);
    return made;
  }
};

int64_t now_us() {
  using namespace std::chrono;
  return duration_cast<microseconds>(steady_clock::now().time_since_epoch()).count();
}

ros::TransportHints no_delay() { return ros::TransportHints().tcpNoDelay(); }

class Component {
 public:
  explicit Component(const Shape& shape) : shape_(shape), sources_(shape.sources()), newest_(sources_.size()) {
    data_ = node_.advertise<bench::Sample>("/data" + std::to_string(shape.index), kQueue);
    dones_ = node_.advertise<bench::Signal>("/done", kQueue);
    for (size_t number = 0; number < sources_.size(); ++number)
      subscribers_.push_back(node_.subscribe<bench::Sample>(
          "/data" + std::to_string(sources_[number]), kQueue,
          [this, number](const bench::Sample::ConstPtr& message) { newest_[number] = message; },
          ros::VoidConstPtr(), no_delay()));
    subscribers_.push_back(node_.subscribe<bench::Signal>(
        "/tick" + std::to_string(shape.stage(shape.index)), kQueue,
        [this](const bench::Signal::ConstPtr& message) { on_tick(message->tick); }, ros::VoidConstPtr(), no_delay()));
  }

 private:
  void on_tick(int64_t tick) {
    if (tick == kStop) {
      std::ofstream(shape_.folder + "/component" + std::to_string(shape_.index) + ".json")
          << "{\"iterations\": " << iterations_ << ", \"stale\": " << stale_ << "}";
      ros::requestShutdown();
      return;
    }
    if (tick > last_) iterate(tick);
    bench::Signal done;
    done.tick = tick;
    done.component = shape_.index;
    dones_.publish(done);
  }

  void iterate(int64_t tick) {
    const int stage = shape_.stage(shape_.index);
    bench::Sample made;
    double x = 1.0, y = -1.0;
    for (size_t number = 0; number < sources_.size(); ++number) {
      const auto& message = newest_[number];
      const int64_t expected = shape_.stage(sources_[number]) < stage ? tick : tick - 1;
      if (tick > shape_.last_warm_up_tick && (message ? message->header.tick : 0) < expected) ++stale_;
      if (message) x += message->x_m, y += message->y_m;
    }
    made.header.tick = made.header.sequence = tick;
    made.header.time_us = tick * 10000;
    made.header.stage = stage;
    made.header.writer = "bench/c" + std::to_string(shape_.index);
    made.x_m = std::fmod(x, 100.0);
    made.y_m = std::fmod(y, 100.0);
    made.heading_rad = shape_.index * 0.01;
    made.confidence = 0.5;
    for (int index = 0; index < 16; ++index) made.covariance[index] = 0.01 * index;
    made.n_padding = shape_.padding;
    made.padding.resize(shape_.padding);
    data_.publish(made);
    last_ = tick;
    ++iterations_;
  }

  Shape shape_;
  std::vector<int> sources_;
  std::vector<bench::Sample::ConstPtr> newest_;
  ros::NodeHandle node_;
  ros::Publisher data_, dones_;
  std::vector<ros::Subscriber> subscribers_;
  int64_t last_ = 0, iterations_ = 0, stale_ = 0;
};

class Supervisor {
 public:
  explicit Supervisor(const Shape& shape) : shape_(shape), control_(connect(shape.folder + "/control")) {
    dones_ = node_.subscribe<bench::Signal>(
        "/done", kQueue,
        [this](const bench::Signal::ConstPtr& message) {
          if (message->tick == tick_) waiting_.erase(message->component);
        },
        ros::VoidConstPtr(), no_delay());
    for (int stage = 0; stage < shape.stages; ++stage)
      ticks_.push_back(node_.advertise<bench::Signal>("/tick" + std::to_string(stage), kQueue));
  }

  void run() {
    run_tick(1);
    const int64_t first_us = now_us();
    for (int64_t tick = 2; tick <= kWarmUpTicks || now_us() < first_us + kWarmUpUs; ++tick) run_tick(tick);
    int64_t tick = shape_.last_warm_up_tick;
    run_tick(tick);
    answer("{\"first_tick_us\": " + std::to_string(first_us) + "}");
    for (std::string line; !(line = read_line()).empty() && line != "stop";) tick = measure(line, tick);
    for (int stage = 0; stage < shape_.stages; ++stage) begin(stage, kStop);
    ros::WallDuration(0.3).sleep();  // the last ticks are on their way
  }

  void answer(const std::string& text) {
    const std::string line = text + "\n";
    if (write(control_, line.data(), line.size()) < 0) throw std::runtime_error("the driver has gone");
  }

 private:
  static int connect(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof(address.sun_path) - 1);
    const int made = socket(AF_UNIX, SOCK_STREAM, 0);
    if (::connect(made, reinterpret_cast<sockaddr*>(&address), sizeof(address)))
      throw std::runtime_error(path + ": nobody listens");
    return made;
  }

  std::string read_line() const {
    std::string line;
    for (char letter; read(control_, &letter, 1) == 1 && letter != '\n';) line += letter;
    return line;
  }

  // "go TICKS SECONDS": answers with the wall time of each tick; returns the last tick's number.
  int64_t measure(const std::string& line, int64_t tick) {
    std::istringstream words(line);
    std::string verb;
    int64_t ticks = 0, repeated = 0;
    double seconds = 0;
    words >> verb >> ticks >> seconds;
    std::ostringstream times;
    const int64_t end_us = now_us() + static_cast<int64_t>(seconds * 1e6);
    for (int64_t count = 0; count < ticks; ++count) {
      const int64_t start_us = now_us();
      if (start_us > end_us) break;
      repeated += run_tick(++tick);
      times << (count ? ", " : "") << now_us() - start_us;
    }
    answer("{\"tick_us\": [" + times.str() + "], \"repeated\": " + std::to_string(repeated) + "}");
    return tick;
  }

  void begin(int stage, int64_t tick) {
    bench::Signal message;
    message.tick = tick;
    message.component = -1;
    ticks_[stage].publish(message);
  }

  int run_tick(int64_t tick) {
    int repeated = 0;
    tick_ = tick;
    for (int stage = 0; stage < shape_.stages; ++stage) {
      for (int index = stage; index < shape_.components; index += shape_.stages) waiting_.insert(index);
      const int64_t start_us = now_us();
      int64_t repeat_us = start_us + static_cast<int64_t>(kRepeatS * 1e6);
      double patience_s = kRepeatS;
      if (!waiting_.empty()) begin(stage, tick);
      while (!waiting_.empty()) {
        ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(patience_s));
        if (waiting_.empty() || now_us() < repeat_us) continue;
        if (now_us() > start_us + kGiveUpUs)
          throw std::runtime_error("tick " + std::to_string(tick) + ": no answer from " +
                                   std::to_string(waiting_.size()) + " components");
        ++repeated;
        patience_s = std::min(2 * patience_s, kRepeatMaxS);
        repeat_us = now_us() + static_cast<int64_t>(patience_s * 1e6);
        begin(stage, tick);
      }
    }
    return repeated;
  }

  Shape shape_;
  int control_;
  ros::NodeHandle node_;
  ros::Subscriber dones_;
  std::vector<ros::Publisher> ticks_;
  int64_t tick_ = 0;
  std::set<int> waiting_;
};

}  // namespace

int main(int argc, char** argv) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // nobody is left behind when the run is killed
  if (argc < 8) {
    std::fprintf(stderr, "node INDEX COMPONENTS STAGES READS PADDING_BYTES LAST_WARM_UP_TICK FOLDER\n");
    return 2;
  }
  const Shape shape{std::stoi(argv[1]), std::stoi(argv[2]),  std::stoi(argv[3]), std::stoi(argv[4]),
                    std::stoi(argv[5]), std::stoll(argv[6]), argv[7]};
  int none = 0;
  ros::init(none, nullptr, shape.index < 0 ? "supervisor" : "c" + std::to_string(shape.index),
            ros::init_options::NoRosout | ros::init_options::NoSigintHandler);
  if (shape.index >= 0) {
    Component component(shape);
    ros::spin();
    return 0;
  }
  Supervisor supervisor(shape);
  try {
    supervisor.run();
  } catch (const std::runtime_error& error) {
    supervisor.answer(std::string("{\"error\": \"") + error.what() + "\"}");
    return 1;
  }
}
