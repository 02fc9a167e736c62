#include "core/parallel/background_task.hpp"

#include <gtest/gtest.h>

#include <future>
#include <stdexcept>

namespace talus::background_task_test {
namespace {

TEST(BackgroundTask, WorksBesideTheCallerOnOneThread)
{
  const int before = threads();
  set_threads(3);
  BackgroundTask task;
  std::promise<void> go_on;
  int threads_there = 0;
  std::thread::id where;
  EXPECT_TRUE(task.is_done());
  task.start([&] {
    go_on.get_future().wait();  // would never return if start() did the work
    threads_there = threads();
    where = std::this_thread::get_id();
  });
  EXPECT_FALSE(task.is_done());
  go_on.set_value();
  task.wait();
  EXPECT_TRUE(task.is_done());
  EXPECT_EQ(threads_there, 1);
  EXPECT_EQ(threads(), 3) << "the number of the caller";
  set_threads(before);
  EXPECT_NE(where, std::this_thread::get_id());
}

TEST(BackgroundTask, StartWaitsForTheWorkBefore)
{
  BackgroundTask task;
  std::atomic<int> at_work = 0, most = 0;
  for (int i = 0; i < 20; ++i)
    task.start([&] {
      most = std::max(most.load(), ++at_work);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      --at_work;
    });
  task.wait();
  EXPECT_EQ(most, 1);
}

TEST(BackgroundTask, AnExceptionIsThrownOnceByTheNextCall)
{
  BackgroundTask task;
  const auto fail = [] { throw std::runtime_error("the disk is full"); };
  task.start(fail);
  EXPECT_THROW(task.wait(), std::runtime_error);
  EXPECT_NO_THROW(task.wait());
  task.start(fail);
  bool done = false;
  EXPECT_THROW(task.start([&] { done = true; }), std::runtime_error);
  EXPECT_FALSE(done);
}

TEST(BackgroundTask, OthersCanWaitForItsEndAndItsException)
{
  BackgroundTask task;
  EXPECT_FALSE(task.result().valid());
  std::promise<void> go_on;
  task.start([&] {
    go_on.get_future().wait();
    throw std::runtime_error("the disk is full");
  });
  auto other = std::async(std::launch::async, [end = task.result()] { end.get(); });
  EXPECT_EQ(other.wait_for(std::chrono::milliseconds(20)), std::future_status::timeout);
  go_on.set_value();
  EXPECT_THROW(other.get(), std::runtime_error);
  EXPECT_THROW(task.wait(), std::runtime_error);
  EXPECT_FALSE(task.result().valid());
}

TEST(BackgroundTask, TheDestructorWaitsAndReleasesTheWork)
{
  const auto held = std::make_shared<int>(0);
  {
    BackgroundTask task;
    task.start([held] {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      ++*held;
    });
  }
  EXPECT_EQ(*held, 1);
  EXPECT_EQ(held.use_count(), 1);
}

}  // namespace
}  // namespace talus::background_task_test
