//! Tests the command as a user runs it: exit statuses, messages, files.

pub mod command;
mod commands;
mod compare;
mod corpus;
mod epochs;
mod gate;
mod golden;
mod input;
#[cfg(target_os = "linux")]
mod interrupted;
pub mod journal;
#[cfg(target_os = "linux")]
mod names;
mod output;
mod plan;
mod rays;
mod report;
#[cfg(unix)]
mod runner;
mod study;
mod validate;
mod view;
