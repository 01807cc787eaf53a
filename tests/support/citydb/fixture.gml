<?xml version="1.0" encoding="UTF-8"?>
<!-- The house of fixture_v4.sql and fixture_v5.sql, their current versions, as a file. -->
<core:CityModel xmlns:core="http://www.opengis.net/citygml/2.0" xmlns:bldg="http://www.opengis.net/citygml/building/2.0"
  xmlns:gen="http://www.opengis.net/citygml/generics/2.0" xmlns:gml="http://www.opengis.net/gml"
  xmlns:xlink="http://www.w3.org/1999/xlink" xmlns:xAL="urn:oasis:names:tc:ciq:xsdschema:xAL:2.0">
  <gml:boundedBy><gml:Envelope srsName="urn:ogc:def:crs:EPSG::25832" srsDimension="3">
    <gml:lowerCorner>500000 5700000 100</gml:lowerCorner><gml:upperCorner>500013 5700008 108</gml:upperCorner>
  </gml:Envelope></gml:boundedBy>
  <core:cityObjectMember>
    <bldg:Building gml:id="house">
      <gml:description>Made of five walls</gml:description>
      <gml:name>The house</gml:name>
      <core:creationDate>2024-05-06</core:creationDate>
      <core:relativeToTerrain>entirelyAboveTerrain</core:relativeToTerrain>
      <gen:stringAttribute name="owner"><gen:value>C. Ampersand &amp; Sons</gen:value></gen:stringAttribute>
      <gen:intAttribute name="flats"><gen:value>3</gen:value></gen:intAttribute>
      <gen:doubleAttribute name="share"><gen:value>0.125</gen:value></gen:doubleAttribute>
      <gen:uriAttribute name="page"><gen:value>https://example.org/house</gen:value></gen:uriAttribute>
      <gen:dateAttribute name="inspected"><gen:value>2023-02-01</gen:value></gen:dateAttribute>
      <gen:measureAttribute name="area"><gen:value uom="m2">80.5</gen:value></gen:measureAttribute>
      <gen:genericAttributeSet name="heat"><gen:doubleAttribute name="kWh"><gen:value>12500</gen:value></gen:doubleAttribute></gen:genericAttributeSet>
      <bldg:class codeSpace="classes.xml">1000</bldg:class>
      <bldg:function codeSpace="functions.xml">1100</bldg:function>
      <bldg:function codeSpace="functions.xml">1200</bldg:function>
      <bldg:yearOfConstruction>1950</bldg:yearOfConstruction>
      <bldg:roofType>1010</bldg:roofType>
      <bldg:measuredHeight uom="m">6</bldg:measuredHeight>
      <bldg:storeysAboveGround>2</bldg:storeysAboveGround>
      <bldg:storeyHeightsAboveGround uom="m">3.5 2.5</bldg:storeyHeightsAboveGround>
      <bldg:lod2Solid><gml:Solid gml:id="house_solid"><gml:exterior>
        <gml:CompositeSurface gml:id="house_shell">
          <gml:surfaceMember xlink:href="#p_south"/>
          <gml:surfaceMember xlink:href="#p_east"/>
          <gml:surfaceMember xlink:href="#p_north"/>
          <gml:surfaceMember xlink:href="#p_west"/>
          <gml:surfaceMember xlink:href="#p_roof"/>
          <gml:surfaceMember><gml:OrientableSurface orientation="-"><gml:baseSurface xlink:href="#p_ground"/></gml:OrientableSurface></gml:surfaceMember>
        </gml:CompositeSurface>
      </gml:exterior></gml:Solid></bldg:lod2Solid>
      <bldg:outerBuildingInstallation><bldg:BuildingInstallation gml:id="antenna">
        <core:creationDate>2024-05-06</core:creationDate>
        <bldg:function>1020</bldg:function>
        <bldg:lod2ImplicitRepresentation><core:ImplicitGeometry>
          <core:transformationMatrix>0 -1 0 0 1 0 0 0 0 0 1 0 0 0 0 1</core:transformationMatrix>
          <core:relativeGMLGeometry><gml:MultiSurface gml:id="antenna_geometry">
            <gml:surfaceMember><gml:Polygon gml:id="ant_1"><gml:exterior><gml:LinearRing><gml:posList>0 0 2 1 0 0 0 1 0 0 0 2</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
            <gml:surfaceMember><gml:Polygon gml:id="ant_2"><gml:exterior><gml:LinearRing><gml:posList>0 0 2 0 1 0 0 0 0 0 0 2</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
            <gml:surfaceMember><gml:Polygon gml:id="ant_3"><gml:exterior><gml:LinearRing><gml:posList>0 0 2 0 0 0 1 0 0 0 0 2</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
            <gml:surfaceMember><gml:Polygon gml:id="ant_4"><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 1 0 1 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
          </gml:MultiSurface></core:relativeGMLGeometry>
          <core:referencePoint><gml:Point><gml:pos>500005 5700004 106</gml:pos></gml:Point></core:referencePoint>
        </core:ImplicitGeometry></bldg:lod2ImplicitRepresentation>
      </bldg:BuildingInstallation></bldg:outerBuildingInstallation>
      <bldg:boundedBy><bldg:WallSurface gml:id="walls">
        <bldg:lod2MultiSurface><gml:MultiSurface>
          <gml:surfaceMember><gml:Polygon gml:id="p_south"><gml:exterior><gml:LinearRing><gml:posList>500000 5700000 100 500010 5700000 100 500010 5700000 106 500000 5700000 106 500000 5700000 100</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
          <gml:surfaceMember><gml:Polygon gml:id="p_east"><gml:exterior><gml:LinearRing><gml:posList>500010 5700000 100 500010 5700008 100 500010 5700008 106 500010 5700000 106 500010 5700000 100</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
          <gml:surfaceMember><gml:Polygon gml:id="p_north"><gml:exterior><gml:LinearRing><gml:posList>500010 5700008 100 500000 5700008 100 500000 5700008 106 500010 5700008 106 500010 5700008 100</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
          <gml:surfaceMember><gml:Polygon gml:id="p_west"><gml:exterior><gml:LinearRing><gml:posList>500000 5700008 100 500000 5700000 100 500000 5700000 106 500000 5700008 106 500000 5700008 100</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
        </gml:MultiSurface></bldg:lod2MultiSurface>
      </bldg:WallSurface></bldg:boundedBy>
      <bldg:boundedBy><bldg:RoofSurface gml:id="roof">
        <bldg:lod2MultiSurface><gml:MultiSurface>
          <gml:surfaceMember><gml:Polygon gml:id="p_roof"><gml:exterior><gml:LinearRing><gml:posList>500000 5700000 106 500010 5700000 106 500010 5700008 106 500000 5700008 106 500000 5700000 106</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
        </gml:MultiSurface></bldg:lod2MultiSurface>
      </bldg:RoofSurface></bldg:boundedBy>
      <bldg:boundedBy><bldg:GroundSurface gml:id="ground">
        <bldg:lod2MultiSurface><gml:MultiSurface>
          <gml:surfaceMember><gml:OrientableSurface orientation="-"><gml:baseSurface><gml:Polygon gml:id="p_ground"><gml:exterior><gml:LinearRing><gml:posList>500000 5700000 100 500010 5700000 100 500010 5700008 100 500000 5700008 100 500000 5700000 100</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:baseSurface></gml:OrientableSurface></gml:surfaceMember>
        </gml:MultiSurface></bldg:lod2MultiSurface>
      </bldg:GroundSurface></bldg:boundedBy>
      <bldg:consistsOfBuildingPart><bldg:BuildingPart gml:id="annex">
      <core:creationDate>2024-05-06</core:creationDate>
      <gen:stringAttribute name="use"><gen:value>shed</gen:value></gen:stringAttribute>
      <bldg:measuredHeight uom="m">3</bldg:measuredHeight>
      <bldg:boundedBy><bldg:WallSurface gml:id="annex_front">
        <bldg:lod3MultiSurface><gml:MultiSurface>
          <gml:surfaceMember><gml:Polygon gml:id="a_south"><gml:exterior><gml:LinearRing><gml:posList>500010 5700000 100 500013 5700000 100 500013 5700000 103 500010 5700000 103 500010 5700000 100</gml:posList></gml:LinearRing></gml:exterior><gml:interior><gml:LinearRing><gml:posList>500011 5700000 101 500011 5700000 102 500012 5700000 102 500012 5700000 101 500011 5700000 101</gml:posList></gml:LinearRing></gml:interior></gml:Polygon></gml:surfaceMember>
        </gml:MultiSurface></bldg:lod3MultiSurface>
        <bldg:opening><bldg:Window gml:id="annex_window">
          <bldg:lod3MultiSurface><gml:MultiSurface>
            <gml:surfaceMember><gml:Polygon gml:id="a_window"><gml:exterior><gml:LinearRing><gml:posList>500011 5700000 101 500012 5700000 101 500012 5700000 102 500011 5700000 102 500011 5700000 101</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
          </gml:MultiSurface></bldg:lod3MultiSurface>
        </bldg:Window></bldg:opening>
      </bldg:WallSurface></bldg:boundedBy>
      <bldg:boundedBy><bldg:WallSurface gml:id="annex_walls">
        <bldg:lod3MultiSurface><gml:MultiSurface>
          <gml:surfaceMember><gml:Polygon gml:id="a_east"><gml:exterior><gml:LinearRing><gml:posList>500013 5700000 100 500013 5700008 100 500013 5700008 103 500013 5700000 103 500013 5700000 100</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
          <gml:surfaceMember><gml:Polygon gml:id="a_north"><gml:exterior><gml:LinearRing><gml:posList>500013 5700008 100 500010 5700008 100 500010 5700008 103 500013 5700008 103 500013 5700008 100</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
        </gml:MultiSurface></bldg:lod3MultiSurface>
      </bldg:WallSurface></bldg:boundedBy>
      <bldg:boundedBy><bldg:RoofSurface gml:id="annex_roof">
        <bldg:lod3MultiSurface><gml:MultiSurface>
          <gml:surfaceMember><gml:Polygon gml:id="a_roof"><gml:exterior><gml:LinearRing><gml:posList>500010 5700000 103 500013 5700000 103 500013 5700008 103 500010 5700008 103 500010 5700000 103</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
        </gml:MultiSurface></bldg:lod3MultiSurface>
      </bldg:RoofSurface></bldg:boundedBy>
      <bldg:boundedBy><bldg:GroundSurface gml:id="annex_ground">
        <bldg:lod3MultiSurface><gml:MultiSurface>
          <gml:surfaceMember><gml:Polygon gml:id="a_ground"><gml:exterior><gml:LinearRing><gml:posList>500010 5700000 100 500010 5700008 100 500013 5700008 100 500013 5700000 100 500010 5700000 100</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
        </gml:MultiSurface></bldg:lod3MultiSurface>
      </bldg:GroundSurface></bldg:boundedBy>
      <bldg:boundedBy><bldg:ClosureSurface gml:id="annex_closure">
        <bldg:lod3MultiSurface><gml:MultiSurface>
          <gml:surfaceMember><gml:Polygon gml:id="a_closure"><gml:exterior><gml:LinearRing><gml:posList>500010 5700008 100 500010 5700000 100 500010 5700000 103 500010 5700008 103 500010 5700008 100</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
        </gml:MultiSurface></bldg:lod3MultiSurface>
      </bldg:ClosureSurface></bldg:boundedBy>
      </bldg:BuildingPart></bldg:consistsOfBuildingPart>
      <bldg:address><core:Address><core:xalAddress><xAL:AddressDetails><xAL:Country><xAL:CountryName>Germany</xAL:CountryName>
        <xAL:Locality Type="Town"><xAL:LocalityName>Berlin</xAL:LocalityName>
          <xAL:Thoroughfare Type="Street"><xAL:ThoroughfareNumber>7</xAL:ThoroughfareNumber><xAL:ThoroughfareName>Turmstrasse</xAL:ThoroughfareName></xAL:Thoroughfare>
          <xAL:PostalCode><xAL:PostalCodeNumber>10559</xAL:PostalCodeNumber></xAL:PostalCode>
        </xAL:Locality></xAL:Country></xAL:AddressDetails></core:xalAddress></core:Address></bldg:address>
    </bldg:Building>
  </core:cityObjectMember>
</core:CityModel>
