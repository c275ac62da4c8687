//! Small writers of binary logs, whose content is known. Not every program that includes them needs all.

#![allow(dead_code)]

pub(crate) mod blackbox;
pub(crate) mod dataflash;
pub(crate) mod ulog;
