// Stands for the overrides of a crowd that has none; programs are given their texts in its place,
// and below them apply_override(number, joint), which calls the right one.
