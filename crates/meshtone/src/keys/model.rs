//! The key `model`.

use super::by_name;
use crate::model::Model;

by_name!(Model, [
    "contact" => Model::Contact,
    "linear" => Model::Linear,
    "published" => Model::Published,
]);
