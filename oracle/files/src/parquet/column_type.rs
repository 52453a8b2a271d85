//! Column types as stored in Parquet: a physical type, and a logical type that defines its meaning.

use parquet::basic::{ConvertedType, LogicalType, Repetition, TimeUnit, Type as PhysicalType};
use parquet::errors::ParquetError;
use parquet::schema::types::{ColumnDescriptor, Type, TypePtr};

use crate::table::column::{Column, ColumnType};

/// Returns the schema of a file with these columns.
pub(crate) fn schema(columns: &[Column]) -> Result<TypePtr, ParquetError> {
    let fields = columns.iter().map(|column| field(column).map(TypePtr::new));
    let root = Type::group_type_builder("schema").with_fields(fields.collect::<Result<_, _>>()?);
    Ok(TypePtr::new(root.build()?))
}

fn field(column: &Column) -> Result<Type, ParquetError> {
    let (physical, logical) = match column.values().column_type() {
        ColumnType::Boolean => (PhysicalType::BOOLEAN, None),
        ColumnType::UInt32 => (PhysicalType::INT32, Some(LogicalType::integer(32, false))),
        ColumnType::UInt64 => (PhysicalType::INT64, Some(LogicalType::integer(64, false))),
        ColumnType::Float32 => (PhysicalType::FLOAT, None),
        ColumnType::Float64 => (PhysicalType::DOUBLE, None),
        ColumnType::Timestamp => (PhysicalType::INT64, Some(LogicalType::timestamp(true, TimeUnit::NANOS))),
        ColumnType::Utf8 => (PhysicalType::BYTE_ARRAY, Some(LogicalType::String)),
    };
    let repetition = if column.is_nullable() { Repetition::OPTIONAL } else { Repetition::REQUIRED };
    let builder = Type::primitive_type_builder(column.name(), physical);
    builder.with_logical_type(logical).with_repetition(repetition).build()
}

/// Returns the type of a column; for a type that Boresight tables do not use, its name in Arrow as the error.
pub(crate) fn column_type(column: &ColumnDescriptor) -> Result<ColumnType, String> {
    let found = value_type(column);
    if column.max_rep_level() == 0 {
        return found;
    }
    Err(format!("List({})", found.map_or_else(|name| name, |known| known.to_string())))
}

/// Returns the type of a column's values. Files written before logical types existed use a converted type
/// instead.
fn value_type(column: &ColumnDescriptor) -> Result<ColumnType, String> {
    let (logical, converted) = (column.logical_type_ref(), column.converted_type());
    match (column.physical_type(), logical) {
        (PhysicalType::BOOLEAN, _) => Ok(ColumnType::Boolean),
        (PhysicalType::FLOAT, _) => Ok(ColumnType::Float32),
        (PhysicalType::DOUBLE, _) => Ok(ColumnType::Float64),
        (PhysicalType::INT32, _) => int32(logical, converted),
        (PhysicalType::INT64, _) => int64(logical, converted),
        (PhysicalType::INT96, _) => Err("Timestamp(ns)".to_owned()),
        (PhysicalType::BYTE_ARRAY, Some(LogicalType::String | LogicalType::Json)) => Ok(ColumnType::Utf8),
        (PhysicalType::BYTE_ARRAY, None)
            if matches!(converted, ConvertedType::UTF8 | ConvertedType::JSON) =>
        {
            Ok(ColumnType::Utf8)
        }
        (_, Some(LogicalType::Decimal(_))) => Err(decimal(column)),
        (_, None) if converted == ConvertedType::DECIMAL => Err(decimal(column)),
        (PhysicalType::BYTE_ARRAY, _) => Err("Binary".to_owned()),
        (PhysicalType::FIXED_LEN_BYTE_ARRAY, Some(LogicalType::Float16)) => Err("Float16".to_owned()),
        (PhysicalType::FIXED_LEN_BYTE_ARRAY, _) => Err(format!("FixedSizeBinary({})", column.type_length())),
    }
}

fn int32(logical: Option<&LogicalType>, converted: ConvertedType) -> Result<ColumnType, String> {
    let name = match (logical, converted) {
        (Some(LogicalType::Integer(int)), _) => match (int.bit_width, int.is_signed) {
            (32, false) => return Ok(ColumnType::UInt32),
            (bits, is_signed) => integer(bits, is_signed),
        },
        (None, ConvertedType::UINT_32) => return Ok(ColumnType::UInt32),
        (None, ConvertedType::UINT_8) => integer(8, false),
        (None, ConvertedType::UINT_16) => integer(16, false),
        (None, ConvertedType::INT_8) => integer(8, true),
        (None, ConvertedType::INT_16) => integer(16, true),
        (None, ConvertedType::NONE | ConvertedType::INT_32) => integer(32, true),
        (Some(LogicalType::Date), _) | (None, ConvertedType::DATE) => "Date32".to_owned(),
        (Some(LogicalType::Time(_)), _) | (None, ConvertedType::TIME_MILLIS) => "Time32(ms)".to_owned(),
        (Some(LogicalType::Decimal(decimal)), _) => {
            format!("Decimal128({}, {})", decimal.precision, decimal.scale)
        }
        (Some(logical), _) => format!("Int32 as {logical:?}"),
        (None, converted) => format!("Int32 as {converted}"),
    };
    Err(name)
}

fn int64(logical: Option<&LogicalType>, converted: ConvertedType) -> Result<ColumnType, String> {
    let name = match (logical, converted) {
        (Some(LogicalType::Integer(int)), _) => match (int.bit_width, int.is_signed) {
            (64, false) => return Ok(ColumnType::UInt64),
            (bits, is_signed) => integer(bits, is_signed),
        },
        (None, ConvertedType::UINT_64) => return Ok(ColumnType::UInt64),
        (None, ConvertedType::NONE | ConvertedType::INT_64) => integer(64, true),
        (Some(LogicalType::Timestamp(time)), _) => match (time.unit, time.is_adjusted_to_u_t_c) {
            (TimeUnit::NANOS, true) => return Ok(ColumnType::Timestamp),
            (unit, true) => format!("Timestamp({}, \"UTC\")", symbol(unit)),
            (unit, false) => format!("Timestamp({})", symbol(unit)),
        },
        (None, ConvertedType::TIMESTAMP_MILLIS) => "Timestamp(ms, \"UTC\")".to_owned(),
        (None, ConvertedType::TIMESTAMP_MICROS) => "Timestamp(µs, \"UTC\")".to_owned(),
        (Some(LogicalType::Time(time)), _) => format!("Time64({})", symbol(time.unit)),
        (None, ConvertedType::TIME_MICROS) => "Time64(µs)".to_owned(),
        (Some(LogicalType::Decimal(decimal)), _) => {
            format!("Decimal128({}, {})", decimal.precision, decimal.scale)
        }
        (Some(logical), _) => format!("Int64 as {logical:?}"),
        (None, converted) => format!("Int64 as {converted}"),
    };
    Err(name)
}

fn integer(bits: i8, is_signed: bool) -> String {
    format!("{}{bits}", if is_signed { "Int" } else { "UInt" })
}

fn symbol(unit: TimeUnit) -> &'static str {
    match unit {
        TimeUnit::MILLIS => "ms",
        TimeUnit::MICROS => "µs",
        TimeUnit::NANOS => "ns",
    }
}

fn decimal(column: &ColumnDescriptor) -> String {
    format!("Decimal128({}, {})", column.type_precision(), column.type_scale())
}

#[cfg(test)]
mod tests {
    use parquet::schema::parser::parse_message_type;
    use parquet::schema::types::SchemaDescriptor;

    use super::*;

    /// Returns the type of the single column of a schema in Parquet notation.
    fn found(field: &str) -> String {
        let schema = parse_message_type(&format!("message schema {{ {field}; }}")).unwrap();
        let columns = SchemaDescriptor::new(TypePtr::new(schema));
        column_type(&columns.column(0)).map_or_else(|name| name, |known| format!("= {known}"))
    }

    #[test]
    fn column_types_are_read_from_logical_and_converted_types() {
        for (field, expected) in [
            ("required boolean x", "= Boolean"),
            ("optional float x", "= Float32"),
            ("required double x", "= Float64"),
            ("required int32 x (INTEGER(32, false))", "= UInt32"),
            ("required int32 x (UINT_32)", "= UInt32"),
            ("required int64 x (INTEGER(64, false))", "= UInt64"),
            ("required int64 x (UINT_64)", "= UInt64"),
            ("optional binary x (STRING)", "= Utf8"),
            ("optional binary x (UTF8)", "= Utf8"),
            ("required int64 x (TIMESTAMP(NANOS, true))", "= Timestamp(ns, \"UTC\")"),
        ] {
            assert_eq!(found(field), expected, "{field}");
        }
    }

    #[test]
    fn other_types_have_their_names() {
        for (field, expected) in [
            ("required int32 x", "Int32"),
            ("required int64 x", "Int64"),
            ("required int32 x (INTEGER(16, true))", "Int16"),
            ("required int32 x (UINT_8)", "UInt8"),
            ("required int64 x (TIMESTAMP(MICROS, true))", "Timestamp(µs, \"UTC\")"),
            ("required int64 x (TIMESTAMP(NANOS, false))", "Timestamp(ns)"),
            ("required int64 x (TIMESTAMP_MILLIS)", "Timestamp(ms, \"UTC\")"),
            ("required int96 x", "Timestamp(ns)"),
            ("required int32 x (DATE)", "Date32"),
            ("required int32 x (DECIMAL(9, 2))", "Decimal128(9, 2)"),
            ("required fixed_len_byte_array(16) x (DECIMAL(30, 2))", "Decimal128(30, 2)"),
            ("required fixed_len_byte_array(5) x", "FixedSizeBinary(5)"),
            ("required binary x", "Binary"),
            ("repeated double x", "List(Float64)"),
        ] {
            assert_eq!(found(field), expected, "{field}");
        }
    }
}
