//! The monitoring of a docking approach (Boguslavsky, Sazonov, Sokolov, Smirnov, Saigiraev, ICINCO 2004).
